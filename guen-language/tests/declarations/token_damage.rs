//! Damaged declarations: tokens of sound ones are deleted, doubled, swapped and replaced, thousands of times and the
//! same in every run. Whatever comes out, nothing panics, the work stays bounded, and every error lies at a token
//! that the user wrote.

use std::time::Instant;

use crate::common::rounds;
use crate::corpus::{ONCE_FAILED, SOUND, check, damaged, pipeline, strangers};
use proc_macro2::TokenStream;

/// A fixed sequence of numbers that looks random (a linear congruential generator, upper bits).
struct Sequence(u64);

impl Sequence {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % limit.max(1)
    }
}

/// More than any of the sound declarations needs, and a hundredth of what a derivation is given up at.
const MOST_WORK: u64 = 1_000_000;

#[test]
fn damage_never_panics_and_is_told_inside_of_the_tokens() {
    let rounds = rounds(300) as usize;
    let started = Instant::now();
    let pool = strangers();
    let sound: Vec<TokenStream> = SOUND.iter().map(|text| text.parse().unwrap()).collect();
    for stream in &sound {
        assert!(!check(stream).0, "the sound declaration has faults:\n{stream}");
    }
    let (mut refused, mut most) = (0, 0);
    let mut sequence = Sequence(7);
    for round in 0..rounds {
        let mut stream = sound[round % sound.len()].clone();
        // Mostly one wound: many end in the parser.
        for _ in 0..=sequence.below(3).pow(2) {
            stream = damaged(stream, &pool, &mut |limit| sequence.below(limit));
        }
        let (has_errors, work) = check(&stream);
        refused += usize::from(has_errors);
        most = most.max(work);
        assert!(work < MOST_WORK, "{work} steps for:\n{stream}");
    }
    println!("{rounds} rounds, {refused} refused, at most {most} steps, {:?}", started.elapsed());
    assert!(refused > rounds / 2, "the damage is too gentle: {refused} of {rounds} refused");
    assert!(refused < rounds, "the damage is too rough: all refused");
}

#[test]
fn what_once_failed_is_told() {
    for text in ONCE_FAILED {
        let stream: TokenStream = text.parse().unwrap();
        assert!(check(&stream).0, "no error for:\n{text}");
    }
}

/// Chains that are deep, but within the limits, end without exhausting the small stack of a test's thread.
#[test]
fn deep_chains_fit_the_stack() {
    let chain =
        |count: usize, link: &dyn Fn(usize) -> String| (1..=count).map(link).collect::<Vec<_>>().join(" ");
    let defaults = chain(900, &|i| format!("c{i} = sin(c{} + 1)/2,", i - 1));
    let positions = chain(900, &|i| format!("let a{i} = cos(a{} + x);", i - 1));
    let velocities = chain(300, &|i| format!("let v{i} = v{}*x + dot(y);", i - 1));
    for text in [
        format!(
            "system A {{ constants {{ c0, {defaults} }} coordinates {{ x }} parameters {{ u = dot(x); }} kinetic_energy = u^2 + c900^2*u^2; }}"
        ),
        format!(
            "system A {{ coordinates {{ x }} let a0 = x; {positions} parameters {{ u = dot(x); }} kinetic_energy = u^2; force_function = a900; }}"
        ),
        format!(
            "system A {{ coordinates {{ x, y }} let v0 = dot(x); {velocities} parameters {{ u = dot(x); w = v300; }} kinetic_energy = u^2 + w^2; }}"
        ),
        format!(
            "system A {{ coordinates {{ x, y }} let v0 = dot(x); {velocities} parameters {{ u = dot(x); w = dot(y); }} kinetic_energy = u^2 + v300^2 + w^2; }}"
        ),
    ] {
        let stream: TokenStream = text.parse().unwrap();
        let (has_errors, _) = check(&stream);
        assert!(!has_errors, "{}", pipeline(stream).0.iter().map(ToString::to_string).collect::<String>());
    }
}

//! Damages sound declarations as the bytes choose, and checks what the damage test checks: no panic, and every error
//! at a token of the input. Run it by `cargo +nightly fuzz run expand` in the root of the repository.
#![no_main]

#[path = "../../../guen-language/tests/declarations/corpus/mod.rs"]
#[allow(dead_code, reason = "the texts that once failed are for the test")]
mod corpus;

use libfuzzer_sys::fuzz_target;
use proc_macro2::TokenStream;

fuzz_target!(|bytes: &[u8]| {
    let mut bytes = bytes.iter().copied();
    let Some(first) = bytes.next() else { return };
    let pool = corpus::strangers();
    let text = corpus::SOUND[usize::from(first) % corpus::SOUND.len()];
    let mut stream: TokenStream = text.parse().expect("the sound declarations are tokens");
    // Each choice takes two bytes; a wound begins while some are left.
    while bytes.len() > 0 {
        let mut below = |limit: usize| {
            let (low, high) = (bytes.next().unwrap_or(0), bytes.next().unwrap_or(0));
            usize::from(u16::from_le_bytes([low, high])) % limit.max(1)
        };
        stream = corpus::damaged(stream, &pool, &mut below);
    }
    corpus::check(&stream);
});

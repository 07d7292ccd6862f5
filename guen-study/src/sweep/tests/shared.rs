//! Chunks handed out by a coordinator.

use std::sync::Mutex;

use super::*;
use crate::sweep::plan::Plan;
use crate::sweep::record::Record;
use crate::{Assignment, Coordinator};

/// Hands out all chunks that are left to so many workers, on threads. Returns those that were computed.
fn all(sweep: &Sweep<'_>, coordinator: Coordinator, folder: &Path, workers: usize) -> Vec<u64> {
    let (coordinator, assigned) = (Mutex::new(coordinator), Mutex::new(Vec::new()));
    let work = || {
        let worker = sweep.worker(folder).unwrap();
        loop {
            let next = coordinator.lock().unwrap().assign();
            let Some(assignment) = next else { break };
            assigned.lock().unwrap().push(assignment.to_bits());
            let finished = worker.compute(Assignment::from_bits(assignment.to_bits())).unwrap();
            coordinator.lock().unwrap().count(&finished).unwrap();
        }
    };
    std::thread::scope(|scope| {
        (0..workers).for_each(|_| {
            scope.spawn(work);
        });
    });
    let report = coordinator.into_inner().unwrap().finish().unwrap();
    let mut assigned = assigned.into_inner().unwrap();
    assigned.sort();
    assert_eq!(report.computed, assigned.len() as u64);
    assigned
}

#[test]
fn workers_leave_the_files_of_one_part() {
    let folder = Folder::new("shared");
    let whole = ends(333).run_in(folder.below("whole")).unwrap();
    for workers in [1, 2, 5] {
        let place = folder.below(&format!("of-{workers}"));
        let computed = all(&ends(333), ends(333).coordinator(&place).unwrap(), &place, workers);
        assert_eq!(computed, (0..9).collect::<Vec<u64>>());
        assert_eq!(ends(333).merge([&place], &place).unwrap(), whole);
        assert_eq!(differing(&files(&place), &files(&folder.below("whole"))), NONE, "{workers}");
    }
}

#[test]
fn a_further_coordinator_hands_out_what_is_missing() {
    let folder = Folder::new("shared-again");
    ends(333).run_in(folder.below("whole")).unwrap();
    let (place, sweep) = (folder.below("shared"), ends(333));
    let mut coordinator = sweep.coordinator(&place).unwrap();
    let worker = sweep.worker(&place).unwrap();
    let texts: Vec<String> = (0..5)
        .map(|_| worker.compute(coordinator.assign().unwrap()).unwrap())
        // The fifth is computed, but nobody hears of it.
        .take(4)
        .collect();
    texts[..3].iter().for_each(|text| coordinator.count(text).unwrap());
    // One that is told twice counts once.
    coordinator.count(&texts[0]).unwrap();
    drop(worker);
    let report = coordinator.finish().unwrap();
    assert_eq!((report.found, report.computed), (0, 4));
    // One of the three has lost its file: it is computed again, and its statistics are not counted again.
    std::fs::remove_file(place.join("rows/chunk-00000001.csv")).unwrap();
    let coordinator = sweep.coordinator(&place).unwrap();
    assert_eq!(all(&sweep, coordinator, &place, 2), [1, 3, 4, 5, 6, 7, 8]);
    let report = sweep.coordinator(&place).unwrap().finish().unwrap();
    assert_eq!((report.found, report.computed, report.rewritten), (9, 0, 0));
    sweep.merge([&place], &place).unwrap();
    assert_eq!(differing(&files(&place), &files(&folder.below("whole"))), NONE);
}

#[test]
fn messages_that_cannot_be_counted_are_refused() {
    let folder = Folder::new("shared-messages");
    let sweep = ends(100);
    let mut coordinator = sweep.coordinator(&folder.0).unwrap();
    let worker = sweep.worker(&folder.0).unwrap();
    let first = coordinator.assign().unwrap();
    let text = worker.compute(first).unwrap();
    let other = ends(101);
    let elsewhere = folder.below("other");
    let mut other_coordinator = other.coordinator(&elsewhere).unwrap();
    let of_another = other.worker(&elsewhere).unwrap().compute(other_coordinator.assign().unwrap()).unwrap();
    let plan = Plan::of(&sweep).unwrap();
    let mut without = Record::parse(&plan, &text).unwrap();
    without.statistics = Record::new(&plan).statistics;
    let mut two = Record::parse(&plan, &text).unwrap();
    two.chunks.insert(1, two.chunks[&0].clone());
    for (message, expected) in [
        (&text[..text.len() - 9], "does not fit its digest"),
        (&text.replacen("chunk 0", "chunk 1", 1), "does not fit its digest"),
        ("", "its end is missing"),
        (&of_another, "belongs to another sweep"),
        (&without.text(&plan), "are not those of its chunk"),
        (&two.text(&plan), "not about one chunk"),
    ] {
        let error = coordinator.count(message).unwrap_err();
        assert!(matches!(error, SweepError::Message { .. }), "{error}");
        assert!(error.to_string().contains(expected), "{error}");
    }
    let error = worker.compute(Assignment::from_bits(3)).unwrap_err();
    assert!(error.to_string().ends_with("the sweep has no such chunk"), "{error}");
    coordinator.count(&text).unwrap();
    assert_eq!(coordinator.finish().unwrap().computed, 1);
}

#[test]
fn workers_belong_to_one_coordinator() {
    let folder = Folder::new("shared-busy");
    let sweep = ends(100);
    let missing = sweep.worker(folder.below("nowhere")).unwrap_err();
    assert!(matches!(missing, SweepError::Io { .. }), "{missing}");
    let coordinator = sweep.coordinator(&folder.0).unwrap();
    let busy = |error: SweepError| assert!(matches!(error, SweepError::Busy { .. }), "{error}");
    busy(sweep.coordinator(&folder.0).unwrap_err());
    let workers = [sweep.worker(&folder.0).unwrap(), sweep.worker(&folder.0).unwrap()];
    // They outlive it: what they write would meet with what others write.
    drop(coordinator);
    busy(sweep.coordinator(&folder.0).unwrap_err());
    busy(sweep.run_in(&folder.0).unwrap_err());
    drop(workers);
    sweep.run_in(&folder.0).unwrap();
    let error = ends(101).worker(&folder.0).unwrap_err();
    assert!(matches!(error, SweepError::OtherSweep { .. }), "{error}");
    let parts = folder.below("parts");
    sweep.part(0, 2).unwrap().run_in(&parts).unwrap();
    let error = sweep.worker(&parts).unwrap_err();
    assert!(matches!(error, SweepError::OtherParts { found: 2, asked: 1, .. }), "{error}");
}

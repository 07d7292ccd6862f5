//! Histograms and manifests that make no sense, and folders that say so.

use super::*;

#[test]
fn a_column_has_one_histogram_of_a_million_bins_at_most() {
    let refused =
        |sweep: Sweep<'_>| matches!(sweep.run(), Err(SweepError::Histogram { column }) if column == "q");
    let wide = || ends(9).with_histogram("w", -1.0, 1.0, 4);
    assert!(refused(wide().with_histogram("q", 0.0, 1.0, 2).with_histogram("q", 0.0, 2.0, 40)));
    assert!(refused(wide().with_histogram("q", 0.0, 1.0, 1_000_001)));
    assert!(refused(wide().with_histogram("q", 0.0, 1.0, usize::MAX)));
    assert!(wide().with_histogram("q", 0.0, 1.0, 1_000_000).run().is_ok());
}

#[test]
fn a_damaged_manifest_says_what_to_do() {
    let folder = Folder::new("manifest");
    ends(80).run_in(&folder.0).unwrap();
    let expected = files(&folder.0);
    let manifest = folder.below("sweep.txt");
    let text = std::fs::read_to_string(&manifest).unwrap();
    for damaged in
        ["".to_owned(), text[..20].to_owned(), text.replace('\n', "\r\n"), text.replace(": 1\n", ": one\n")]
    {
        std::fs::write(&manifest, &damaged).unwrap();
        for error in
            [ends(80).run_in(&folder.0), ends(80).merge([&folder.0], &folder.0)].map(Result::unwrap_err)
        {
            assert!(
                matches!(&error, SweepError::Corrupt { path, .. } if path.ends_with("sweep.txt")),
                "{error}"
            );
            assert!(
                error.to_string().ends_with("remove it and run again: what is finished is kept"),
                "{error}"
            );
        }
    }
    std::fs::remove_file(&manifest).unwrap();
    assert_eq!(ends(80).part(0, 1).unwrap().run_in(&folder.0).unwrap().computed, 0);
    assert_eq!(differing(&files(&folder.0), &expected), NONE);
}

#[test]
fn as_many_parts_as_there_are_numbers_are_merged_at_once() {
    let folder = Folder::new("parts");
    let report = ends(200).part(3, u64::MAX).unwrap().run_in(&folder.0).unwrap();
    assert_eq!(report.computed, 1);
    let error = ends(200).merge([&folder.0], folder.below("merged")).unwrap_err();
    assert!(matches!(error, SweepError::Unfinished { first: 0, missing: 160 }), "{error}");
    // Names that are none of a record.
    for name in
        ["part-x-of-18446744073709551615.txt", "part-18446744073709551615-of-18446744073709551615.txt"]
    {
        std::fs::write(folder.below(name), "").unwrap();
    }
    let error = ends(200).merge([&folder.0], folder.below("merged")).unwrap_err();
    assert!(matches!(error, SweepError::Unfinished { .. }), "{error}");
}

#[test]
fn extrema_of_zeros_with_and_without_a_sign_are_those_everywhere() {
    /// Nothing moves: after a step zero has lost its sign.
    #[derive(Clone, Copy)]
    struct Still;
    impl<R: Real> System<R, 1> for Still {
        fn rhs(&self, _t: R, _x: &[R; 1]) -> [R; 1] {
            [R::zero()]
        }
    }
    impl Simulate<f64, 1> for Still {
        type State = [f64; 1];
        const STATES: &'static [&'static str] = &["x"];
    }
    impl Laned<1> for Still {
        type Over<L: Lanes> = Still;
        fn gather<'a, L: Lanes>(_member: impl Fn(usize) -> &'a Self) -> Still {
            Still
        }
    }
    for times in [[0.0, 1.0, 1.5], [0.0, 0.0, 1.0]] {
        let starts = Design::points(["x"], [[-0.0]]);
        let sweep = Sweep::of_starts(starts, Still, [1.0]).extrema(Rk4::new(0.5), 0.0, times).silent();
        let summary = sweep.run().unwrap();
        let value = |name: &str| summary.statistics().column(name).unwrap().maximum().unwrap();
        let ends = [value("x_min"), value("x_max")];
        assert_eq!(ends.map(f64::to_bits), [-0.0_f64, 0.0].map(f64::to_bits), "{ends:?}");
    }
}

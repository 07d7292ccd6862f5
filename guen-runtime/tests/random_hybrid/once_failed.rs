//! Drawn systems in which something was once wrong.

use guen_runtime::hybrid::{ElementState, HybridSystem, TransitionKind};

use crate::tree::{Drawn, Four, Row, Stops};

/// Links of which two stops hit in turns, each flight a third of the one before: no flight is lost below the digits of the gaps.
#[test]
fn stops_that_take_turns_come_to_rest() {
    let system = Stops(Drawn {
        base: 0,
        parents: [0, 0, 1],
        lengths: [0.7218302587839032, 0.6448830599077662, 0.605774650127282],
        centers: [0.4616275874771445, 0.274271748721419, 0.5754636152764377],
        masses: [1.6841425917699246, 1.6244725666343998, 1.5009435593533202],
        inertias: [0.3954468156966137, 0.28968102318317407, 0.17362324451360978],
        springs: [1.1071240148926353, 1.5088602293309843, 4.104473851875757],
        dampers: [0.028074843548742488, 0.019416057602543866, 0.05095022958609778],
        constant: None,
        push: [0.0, 0.0, 0.0],
        rows: [Row::Angle { link: 1, sign: 1.0 }, Row::Angle { link: 2, sign: 1.0 }],
        gaps: [Some((0, -1.0926544539347725)), Some((1, -0.9091159012902392))],
        friction: [0.46223476500549987, 0.08779854840023621],
        limits: [0.0, 0.0],
        restitutions: [0.4369256643022533, 0.07122574016327454],
    });
    let start = [
        -2.8915455554721112,
        -1.2039465145993222,
        0.12859041901649726,
        0.9545801446940554,
        -1.6282684671087795,
        1.3902326525135882,
    ];
    let motion = system.simulation(&start).tolerance(1e-10).run(0.0..0.4).unwrap();
    let gap = |state: &[f64; 6], c: usize| {
        let (row, offset) = system.0.gaps[c].unwrap();
        system.0.row(&core::array::from_fn(|k| state[k]), &[0.0; 3], system.0.rows[row]).0 + offset
    };
    for transition in motion.transitions() {
        for c in 0..2 {
            let low = gap(&transition.state_before, c);
            assert!(low > -1e-12, "{low:e} at {}", transition.t);
        }
    }
    let last = motion.transitions().last().unwrap();
    assert!(matches!(last.kind, TransitionKind::Rest { .. }), "{last:?}");
    assert_eq!(last.after.0, [ElementState::Closed; 2]);
}

/// A foot and a stop that hit in turns, of which the foot would leave if the stop did not press it down: its flights are as low as the
/// digits of its gap, and end with those of the stop.
#[test]
fn a_foot_that_a_stop_presses_down_comes_to_rest() {
    let system = Four(Drawn {
        base: 2,
        parents: [0, 1, 2, 2],
        lengths: [1.197848579159046, 0.9318668646840995, 0.8257780867135858, 0.9377849306501871],
        centers: [0.42940873273398283, 0.5751228291312801, 0.29603485985761646, 0.3516863234673816],
        masses: [0.6812385410427415, 1.533276346827933, 0.7548595368941169, 1.07510084193479],
        inertias: [0.35682173039422116, 0.11478585158696893, 0.09025231831574539, 0.2326679247761521],
        springs: [1.1310339279278718, 0.17241296517346683, 0.0, 4.788354202937113],
        dampers: [0.1308503654599869, 0.046958421693962894, 0.0, 0.2573526413144591],
        constant: None,
        push: [0.0, 0.0, 0.0, 0.0],
        rows: [
            Row::Point { link: 2, at: 0.8736707292015329, along: [0.14992808867739804, 0.9886969041245868] },
            Row::Point { link: 2, at: 0.8736707292015329, along: [0.9886969041245868, -0.14992808867739804] },
            Row::Point { link: 3, at: 0.6031258866638861, along: [0.14992808867739804, 0.9886969041245868] },
            Row::Point { link: 3, at: 0.6031258866638861, along: [0.9886969041245868, -0.14992808867739804] },
            Row::Angle { link: 3, sign: 1.0 },
            Row::Angle { link: 2, sign: 1.0 },
        ],
        gaps: [
            Some((0, 0.3345526090690596)),
            Some((2, 0.3345526090690596)),
            Some((4, -1.9457693116396675)),
            None,
        ],
        friction: [0.5557802801374135, 0.5935005049707278, 0.4037033209276449, 0.47841715828854897],
        limits: [0.0, 0.0, 0.0, 0.2709897451392961],
        restitutions: [0.20511886097772514, 0.1207465915973488, 0.1564546100773061, 0.2513542346848674],
    });
    let start = [
        0.0,
        0.0,
        -0.3862956934255184,
        1.7038833681877747,
        -0.15098264249574322,
        0.9892639675680783,
        -0.8589957672045245,
        0.06038363931166746,
    ];
    let motion = system.simulation(&start).tolerance(1e-10).run(0.0..2.0).unwrap();
    let transitions = motion.transitions();
    assert!(transitions.len() < 1000, "{}", transitions.len());
    assert_eq!(
        transitions.last().unwrap().after.0[..3],
        [ElementState::Stick, ElementState::Stick, ElementState::Closed]
    );
}

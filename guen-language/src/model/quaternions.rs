//! Finds the coordinates that are unit quaternions: reduced bases take rotation components in their place.

use guen_symbolic::{ExprId, Holonomic, Workbench};

/// The arguments of `quaternion` that are four coordinates of their own, with a holonomic constraint on their norm.
pub(super) fn unit_quaternions(
    bench: &mut Workbench,
    arguments: &[[ExprId; 4]],
    coordinates: &[ExprId],
    holonomic: &[Holonomic],
) -> Vec<[usize; 4]> {
    let mut found: Vec<[usize; 4]> = Vec::new();
    for q in arguments {
        let places = q.map(|e| coordinates.iter().position(|coordinate| *coordinate == e));
        let [Some(w), Some(x), Some(y), Some(z)] = places else { continue };
        let places = [w, x, y, z];
        let distinct = (0..4).all(|i| places[..i].iter().all(|other| *other != places[i]));
        if !distinct || found.iter().flatten().any(|known| places.contains(known)) {
            continue;
        }
        let has_norm = holonomic.iter().any(|constraint| {
            let slopes =
                coordinates.iter().map(|x| bench.partial(constraint.equation, *x)).collect::<Vec<_>>();
            let ratio = bench.graph.div(slopes[w], q[0]);
            bench.graph.as_number(ratio).is_some_and(|number| !number.is_zero())
                && slopes.iter().enumerate().all(|(i, slope)| {
                    let expected = match places.iter().position(|place| *place == i) {
                        Some(k) => bench.graph.mul(ratio, q[k]),
                        None => bench.graph.zero(),
                    };
                    *slope == expected
                })
        });
        if has_norm {
            found.push(places);
        }
    }
    found
}

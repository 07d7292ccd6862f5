//! Functions that are constant where the holonomic constraints hold.

use crate::algebra::{ExprId, Role, Roles};
use crate::motion::{Frame, Mechanics};
use crate::workbench::Workbench;

/// Whether a function is constant on the holonomic constraints: `X_j f = 0` there for all `j` whose displacement stays on them.
pub(in crate::motion) fn rests(bench: &mut Workbench, system: &Mechanics, frame: &Frame, e: ExprId) -> bool {
    // Where it vanishes on all of them it rests, and its derivatives may be large.
    if bench.is_seen_to_vanish(e) {
        return true;
    }
    let forms = &system.forms;
    let by_time = bench.partial(e, forms.time);
    let gradient: Vec<ExprId> = forms.coordinates.iter().map(|x| bench.partial(e, *x)).collect();
    (0..=forms.len()).filter(|j| system.holonomic.iter().all(|h| h.form + 1 != *j)).all(|j| {
        let rate = bench.dot(&frame.operators.xi[j], &gradient);
        let rate = if j == 0 { bench.graph.add(by_time, rate) } else { rate };
        bench.is_seen_to_vanish(rate)
    })
}

/// Whether all derivatives by the variables vanish where the holonomic constraints hold.
pub(in crate::motion) fn is_constant(bench: &mut Workbench, e: ExprId, variables: &[ExprId]) -> bool {
    variables.iter().all(|x| {
        let slope = bench.partial(e, *x);
        bench.graph.is_zero(slope) || bench.is_seen_to_vanish(slope)
    })
}

/// Whether a function that is constant wherever it has derivatives is another constant elsewhere, as `sign(x)` is.
pub(in crate::motion) fn jumps(bench: &mut Workbench, e: ExprId) -> bool {
    let moving = Roles::of(Role::Coordinate).or(Roles::of(Role::Time));
    bench.graph.roles(e).meets(moving) && bench.zero.has_several_values(&bench.graph, e)
}

#[cfg(test)]
mod tests {
    use super::rests;
    use crate::algebra::Graph;
    use crate::geometry::{Form, Operators};
    use crate::motion::definition::proof::tests::system;
    use crate::motion::{Frame, Holonomic};
    use crate::workbench::Workbench;

    /// On a floor that rises with the time, a height over it rests, and neither the time nor a height by itself.
    #[test]
    fn what_moves_with_a_constraint_rests() {
        let mut bench = Workbench::new(Graph::new());
        let mut floor = system(&mut bench, &["x", "z"], 1, |graph, _, v, time| {
            let (zero, one) = (graph.zero(), graph.one());
            let rise = graph.ratio(-2, 1);
            let rise = graph.mul(rise, time);
            let forms = [(vec![one, zero], zero), (vec![zero, one], rise)];
            let squares: Vec<_> = v.iter().map(|v| graph.powi(*v, 2)).collect();
            (forms.map(|(row, offset)| Form { row, offset }).to_vec(), graph.sum(squares), zero)
        });
        let (time, x, z) = (floor.forms.time, floor.forms.coordinates[0], floor.forms.coordinates[1]);
        let square = bench.graph.powi(time, 2);
        let equation = bench.graph.sub(z, square);
        floor.holonomic.push(Holonomic { form: 1, equation });
        let operators = Operators::new(&mut bench, &floor.forms).ok().unwrap();
        let frame = Frame::new(&mut bench, &floor, operators);
        let three = bench.graph.ratio(3, 1);
        let height = bench.graph.add(equation, three);
        assert!(rests(&mut bench, &floor, &frame, height));
        let aside = bench.graph.add(height, x);
        for moves in [time, z, x, square, aside] {
            assert!(!rests(&mut bench, &floor, &frame, moves));
        }
    }
}

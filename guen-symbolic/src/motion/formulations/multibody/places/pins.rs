//! Pins: points that are given by coordinates in the world, and that constraints hold where something else is.
//!
//! A constraint `p - r = 0` keeps the point `p` at the place `r`. On the motion `p' = r'`, so that the mass at `p` moves as the place
//! `r` does, which hangs on fewer coordinates: rods that are pinned to each other hang on each other.

use crate::algebra::{ExprId, FastMap};
use crate::motion::Mechanics;
use crate::motion::graph::{FrameId, Motion, Place};
use crate::workbench::Workbench;

/// The coordinates that are the components of a point in the world, where it has one.
type Point = [Option<ExprId>; 3];

/// A place that does not move, solved for the coordinates of a point.
pub(super) struct Pin {
    /// The place without points that were pinned before.
    place: Place,
    /// The place as it is declared.
    pub(super) declared: Place,
    /// The point.
    pub(super) point: Point,
    /// The factor of the point in the place.
    pub(super) factor: ExprId,
}

/// The pins of a system.
pub(super) struct Pins {
    pub(super) list: Vec<Pin>,
    /// The pin of a coordinate.
    of: FastMap<ExprId, usize>,
}

impl Pins {
    /// The pins among the constraints of a system.
    pub(super) fn new(bench: &mut Workbench, system: &Mechanics) -> Self {
        let mut pins = Pins { list: Vec::new(), of: FastMap::default() };
        for vector in &system.structure.vectors {
            let Some(declared) = at_rest(bench, system, vector) else { continue };
            let place = pins.reduced(bench, &declared);
            let Some((point, factor)) = point_of(bench, system, &place) else { continue };
            for x in point.into_iter().flatten() {
                pins.of.insert(x, pins.list.len());
            }
            pins.list.push(Pin { place, declared, point, factor });
        }
        pins
    }

    /// A place that moves as another one does, without points that are pinned.
    pub(super) fn reduced(&self, bench: &mut Workbench, place: &Place) -> Place {
        let mut place = place.clone();
        for _ in 0..self.list.len() {
            let coordinates = coordinates_in(bench, &in_world(bench, &place));
            let pinned = coordinates.into_iter().filter_map(|x| Some(&self.list[*self.of.get(&x)?]));
            let found: Vec<&Pin> = pinned.collect();
            let factor = found.into_iter().find_map(|pin| Some((pin, factor_of(bench, &place, &pin.point)?)));
            let Some((pin, factor)) = factor else { break };
            let ratio = bench.graph.div(factor, pin.factor);
            let ratio = bench.graph.neg(ratio);
            let moved = pin.place.times(&mut bench.graph, ratio);
            place = place.plus(&mut bench.graph, &moved);
        }
        place
    }
}

/// The components of a place in the world.
pub(super) fn in_world(bench: &Workbench, place: &Place) -> [ExprId; 3] {
    let own = place.terms.iter().find(|(frame, _)| *frame == FrameId::WORLD);
    own.map_or([bench.graph.zero(); 3], |(_, vector)| *vector)
}

fn coordinates_in(bench: &mut Workbench, components: &[ExprId]) -> Vec<ExprId> {
    let symbols = bench.graph.symbols_in(components);
    symbols.into_iter().map(|symbol| bench.graph.symbol_expr(symbol)).collect()
}

/// The place that three constraints keep at rest.
fn at_rest(bench: &Workbench, system: &Mechanics, vector: &[Option<usize>; 3]) -> Option<Place> {
    let first = vector.iter().flatten().next()?;
    if vector.iter().flatten().any(|j| *j < system.forms.degrees) {
        return None;
    }
    let shape = system.structure.forms.get(*first)?.as_ref()?;
    let [component] = &shape.components[..] else { return None };
    let [(factor, Motion::Rate(place))] = &component.velocity.parts[..] else { return None };
    let is_alone = bench.graph.is_zero(shape.rest) && *factor == bench.graph.one();
    is_alone.then(|| place.clone())
}

/// The youngest point that a place has with a constant factor, and the factor.
fn point_of(bench: &mut Workbench, system: &Mechanics, place: &Place) -> Option<(Point, ExprId)> {
    let world = in_world(bench, place);
    // The coordinates of each component with constant factors, the youngest first.
    let mut candidates: [Vec<(ExprId, ExprId)>; 3] = Default::default();
    for (component, found) in world.iter().zip(&mut candidates) {
        let occurring = coordinates_in(bench, &[*component]);
        let coordinates = system.forms.coordinates.iter().rev().filter(|x| occurring.contains(x));
        for x in coordinates {
            let slope = slope(bench, *component, *x);
            if bench.graph.roles(slope).is_constant() && !bench.graph.is_zero(slope) {
                found.push((*x, slope));
            }
        }
    }
    let first = (0..3).find(|k| !candidates[*k].is_empty())?;
    candidates[first].clone().into_iter().find_map(|(x, factor)| {
        let mut point = [None; 3];
        point[first] = Some(x);
        for k in first + 1..3 {
            if !bench.graph.is_zero(world[k]) {
                let same = |(y, own): &&(ExprId, ExprId)| *own == factor && !point.contains(&Some(*y));
                point[k] = Some(candidates[k].iter().find(same)?.0);
            }
        }
        (factor_of(bench, place, &point) == Some(factor)).then_some((point, factor))
    })
}

/// The constant factor that a point has in a place, if it has one: each coordinate in its own component, and in no other.
fn factor_of(bench: &mut Workbench, place: &Place, point: &Point) -> Option<ExprId> {
    let world = in_world(bench, place);
    let mut factor = None;
    for (j, x) in point.iter().enumerate() {
        let Some(x) = x else { continue };
        for (k, component) in world.iter().enumerate() {
            let slope = slope(bench, *component, *x);
            if j != k && !bench.graph.is_zero(slope) {
                return None;
            }
            if j == k {
                let is_other = factor.is_some_and(|factor| factor != slope);
                if is_other || bench.graph.is_zero(slope) || !bench.graph.roles(slope).is_constant() {
                    return None;
                }
                factor = Some(slope);
            }
        }
    }
    factor
}

fn slope(bench: &mut Workbench, e: ExprId, x: ExprId) -> ExprId {
    let slope = bench.partial(e, x);
    bench.tidy(slope)
}

//! Heights of points of contact whose rates are components of the velocity that a body has there.

use guen_symbolic::{FormShape, FrameId, Motion, Place, Velocity, VelocityComponent};

use crate::model::evaluate::Evaluator;
use crate::model::forms::RawForm;
use crate::model::shapes::axis;

/// Writes the rate of a height, as of `contact.z = 0`, in the velocity of which other constraints take other components: a point of contact
/// moves along the surface, so across it the rate of its place is the velocity of the body. Constraints that are the three components
/// of one velocity are one vector then, as if they had been declared so.
pub(super) fn join(eval: &mut Evaluator<'_>, raw: &mut [RawForm<'_>], degrees: usize) {
    if raw.iter().all(|form| form.position.is_none()) {
        return;
    }
    let mut rolling: Vec<Velocity> = Vec::new();
    for form in &raw[degrees..] {
        let Some([VelocityComponent { velocity, .. }]) =
            form.shape.as_ref().map(|shape| &shape.components[..])
        else {
            continue;
        };
        let has_lever = velocity.parts.iter().any(|(_, motion)| matches!(motion, Motion::Lever(..)));
        if has_lever && !rolling.contains(velocity) {
            rolling.push(velocity.clone());
        }
    }
    for velocity in rolling {
        let Some(vector) = eval.shapes.written_out(&velocity) else { continue };
        let mut places: [Option<usize>; 3] = [0, 1, 2].map(|k| {
            let is_taken = |form: &RawForm<'_>| component(eval, form) == Some((k, &velocity));
            raw[degrees..].iter().position(is_taken)
        });
        for k in (0..3).filter(|k| places[*k].is_none()).collect::<Vec<_>>() {
            let is_height = |form: &RawForm<'_>| {
                form.position.is_some()
                    && component(eval, form).is_some_and(|(own, rate)| {
                        own == k && matches!(&rate.parts[..], [(_, Motion::Rate(_))])
                    })
            };
            let heights: Vec<usize> = (degrees..raw.len()).filter(|place| is_height(&raw[*place])).collect();
            places[k] = heights.into_iter().find_map(|place| {
                let rate = eval.expanded(raw[place].definition);
                let difference = eval.bench.graph.sub(rate, vector[k]);
                eval.bench.vanishes(difference).then_some(place - degrees)
            });
            if let Some(place) = places[k] {
                let graph = &eval.bench.graph;
                let direction = Place::in_axes(graph, FrameId::WORLD, axis(graph, k));
                let components = vec![VelocityComponent { direction, velocity: velocity.clone() }];
                raw[degrees + place].shape = Some(FormShape { components, rest: graph.zero() });
            }
        }
        if places.iter().all(Option::is_some) && !eval.vectors.contains(&(false, places)) {
            eval.vectors.push((false, places));
        }
    }
}

/// The axis of the world and the velocity of which a form is the component.
fn component<'f>(eval: &Evaluator<'_>, form: &'f RawForm<'_>) -> Option<(usize, &'f Velocity)> {
    let graph = &eval.bench.graph;
    let shape = form.shape.as_ref().filter(|shape| graph.is_zero(shape.rest))?;
    let [VelocityComponent { direction, velocity }] = &shape.components[..] else { return None };
    let k = (0..3).find(|k| *direction == Place::in_axes(graph, FrameId::WORLD, axis(graph, *k)))?;
    Some((k, velocity))
}

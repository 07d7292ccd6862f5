//! The order of parameters where there are instances of components: those of the system, then those of each instance.

use crate::model::forms::RawForm;
use crate::syntax::{Declaration, Name};

/// Sorts the parameters, which are the first forms, by the instance that they belong to. Vectors of parameters know their
/// components by their places.
pub(super) fn by_instance(
    declaration: &Declaration,
    raw: &mut [RawForm<'_>],
    degrees: usize,
    vectors: &mut [(bool, [Option<usize>; 3])],
) {
    if declaration.instances.is_empty() {
        return;
    }
    let ranks: Vec<usize> = raw[..degrees].iter().map(|form| rank(declaration, form.entry.written)).collect();
    let mut places: Vec<usize> = (0..degrees).collect();
    places.sort_by_key(|place| ranks[*place]);
    raw[..degrees].sort_by_key(|form| rank(declaration, form.entry.written));
    let now = |before: usize| places.iter().position(|place| *place == before).unwrap_or(before);
    for (_, own) in vectors.iter_mut().filter(|(parameters, _)| *parameters) {
        own.iter_mut().flatten().for_each(|place| *place = now(*place));
    }
}

/// The place of the innermost instance of a name among the instances; zero for the system's own.
pub(super) fn rank(declaration: &Declaration, name: &Name) -> usize {
    let is_inside = |path: &str| name.text.strip_prefix(path).is_some_and(|rest| rest.starts_with('.'));
    let inside = declaration.instances.iter().rposition(|instance| is_inside(&instance.path.text()));
    inside.map_or(0, |place| place + 1)
}

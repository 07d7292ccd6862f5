//! Scenes against the derivation: values that a scene fixes must leave the system regular.
//!
//! What a scene would generate is not supported yet, so that every sound scene ends in one fault at its word.

use guen_symbolic::{Derivation, ExprId, Node, Substitution, Workbench};

use crate::diagnostics::{Fault, Faults};
use crate::model::{Model, SceneEntry};

/// Why fixed values cannot be.
enum Trouble {
    Forms,
    Inertia,
    Division,
}

/// Reports scenes that fix constants so that the system becomes singular, and that the others are not generated.
pub(crate) fn report(model: &mut Model<'_>, derivation: &Derivation, faults: &mut Faults) {
    for scene in std::mem::take(&mut model.scenes) {
        match culprit(model, derivation, &scene) {
            Some((at, name, trouble)) => {
                let what = match trouble {
                    Trouble::Forms => "makes the forms linearly dependent",
                    Trouble::Inertia => "leaves a parameter without inertia",
                    Trouble::Division => "makes the system divide by zero",
                };
                faults.report(
                    Fault::new(at, format!("fixing `{name}` at this value {what}"))
                        .note("the scene would have no equations of motion"),
                );
            }
            None => {
                faults.report(
                    Fault::new(scene.keyword, "scenes are not supported yet")
                        .note("the full system is generated once the scene is removed"),
                );
            }
        }
    }
}

/// The first fixed constant that is trouble by itself, or the last one if only all together are.
fn culprit(
    model: &mut Model<'_>,
    derivation: &Derivation,
    scene: &SceneEntry,
) -> Option<(proc_macro2::Span, String, Trouble)> {
    let bench = &mut model.bench;
    let pairs: Vec<(ExprId, ExprId)> = scene.fixes.iter().map(|fix| (fix.symbol, fix.value)).collect();
    let mut trouble = trouble(bench, derivation, &pairs)?;
    let mut guilty = scene.fixes.last()?;
    for fix in &scene.fixes {
        if let Some(own) = self::trouble(bench, derivation, &[(fix.symbol, fix.value)]) {
            (guilty, trouble) = (fix, own);
            break;
        }
    }
    Some((guilty.span, guilty.name.clone(), trouble))
}

fn trouble(bench: &mut Workbench, derivation: &Derivation, fixed: &[(ExprId, ExprId)]) -> Option<Trouble> {
    let mut values = Substitution::new(fixed.iter().copied());
    let mut at_values = |bench: &mut Workbench, rows: &[Vec<ExprId>]| -> Option<Vec<Vec<ExprId>>> {
        let mut image = Vec::new();
        for row in rows {
            let row: Vec<ExprId> = row.iter().map(|e| values.of(&mut bench.graph, *e)).collect();
            if row.iter().any(|e| matches!(bench.graph.node(*e), Node::Undefined)) {
                return None;
            }
            image.push(row);
        }
        Some(image)
    };
    let forms: Vec<Vec<ExprId>> = derivation.system.forms.forms.iter().map(|form| form.row.clone()).collect();
    for (rows, trouble) in [(forms, Trouble::Forms), (derivation.equations.mass.clone(), Trouble::Inertia)] {
        let Some(rows) = at_values(bench, &rows) else { return Some(Trouble::Division) };
        if let Some(rank) = bench.zero.rank(&mut bench.graph, &rows, true)
            && rank < rows.len()
        {
            return Some(trouble);
        }
    }
    None
}

//! The printed form of a system graph, for tests and for people who want to see what a declaration was taken for.

use std::fmt::Write;

use super::{FormShape, FrameId, Motion, Place, SystemGraph, Turn, VelocityComponent};
use crate::algebra::{ExprId, Graph};

impl SystemGraph {
    /// The graph in lines: frames, bodies, forms and loads, each with what it is made of. The names are those of the forms.
    pub fn text(&self, graph: &Graph, forms: &[String]) -> String {
        let mut text = String::new();
        for (index, frame) in self.frames.iter().enumerate().skip(1) {
            let how = match &frame.turn {
                Turn::About { axis, angle } => {
                    format!("about {} by {}", vector(graph, axis), graph.text(*angle))
                }
                Turn::General { .. } => "by a rotation".to_owned(),
            };
            let (own, parent) = (self.label(FrameId(index as u32)), self.label(frame.parent));
            let _ = writeln!(text, "frame {own}: in {parent} {how}");
        }
        for body in &self.bodies {
            let kind = if body.frame.is_some() { "body" } else { "particle" };
            let name = if body.name.is_empty() { String::new() } else { format!(" {}", body.name) };
            let mut parts = Vec::new();
            if let Some(center) = &body.center {
                parts.push(format!("{} at {}", graph.text(body.mass), self.place(graph, center)));
            }
            if let Some(frame) = body.frame {
                parts.push(format!(
                    "inertia {} in {}",
                    self.entries(graph, &body.inertia),
                    self.label(frame)
                ));
            }
            let _ = writeln!(text, "{kind}{name}: {}", parts.join(", "));
        }
        if let Some(gravity) = &self.gravity {
            let _ = writeln!(text, "gravity {}", vector(graph, gravity));
        }
        for (length, place) in &self.lengths {
            let _ = writeln!(text, "length {}: {}", graph.text(*length), self.place(graph, place));
        }
        for (shape, name) in self.forms.iter().zip(forms) {
            if let Some(shape) = shape {
                let _ = writeln!(text, "form {name}: {}", self.form(graph, shape));
            }
        }
        for shape in self.loads.iter().flatten() {
            let _ = writeln!(text, "load {}", self.form(graph, shape));
        }
        text
    }

    fn label(&self, id: FrameId) -> String {
        let name = &self.frame(id).name;
        if name.is_empty() { format!("#{}", id.index()) } else { name.clone() }
    }

    fn place(&self, graph: &Graph, place: &Place) -> String {
        let term = |(frame, v): &(FrameId, [ExprId; 3])| match *frame {
            FrameId::WORLD => vector(graph, v),
            frame => format!("{}*{}", self.label(frame), vector(graph, v)),
        };
        let terms: Vec<String> = place.terms.iter().map(term).collect();
        if terms.is_empty() { "0".to_owned() } else { terms.join(" + ") }
    }

    fn entries(&self, graph: &Graph, inertia: &[ExprId; 6]) -> String {
        let diagonal = inertia[3..].iter().all(|e| graph.is_zero(*e));
        let shown = if diagonal { &inertia[..3] } else { &inertia[..] };
        list(graph, shown)
    }

    fn form(&self, graph: &Graph, shape: &FormShape) -> String {
        let mut terms: Vec<String> = shape.components.iter().map(|c| self.component(graph, c)).collect();
        if !graph.is_zero(shape.rest) {
            terms.push(graph.text(shape.rest));
        }
        terms.join(" + ")
    }

    fn component(&self, graph: &Graph, component: &VelocityComponent) -> String {
        let part = |(factor, motion): &(ExprId, Motion)| {
            let factor =
                if *factor == graph.one() { String::new() } else { format!("{} ", graph.text(*factor)) };
            match motion {
                Motion::Rate(place) => format!("{factor}rate of ({})", self.place(graph, place)),
                Motion::Spin(frame) => format!("{factor}spin of {}", self.label(*frame)),
                Motion::Lever(frame, place) => {
                    format!("{factor}spin of {} x ({})", self.label(*frame), self.place(graph, place))
                }
                Motion::Given(place) => format!("{factor}({})", self.place(graph, place)),
            }
        };
        let parts: Vec<String> = component.velocity.parts.iter().map(part).collect();
        format!("along {}: {}", self.place(graph, &component.direction), parts.join(" + "))
    }
}

fn vector(graph: &Graph, v: &[ExprId; 3]) -> String {
    list(graph, v)
}

fn list(graph: &Graph, entries: &[ExprId]) -> String {
    let texts: Vec<String> = entries.iter().map(|e| graph.text(*e)).collect();
    format!("({})", texts.join(", "))
}

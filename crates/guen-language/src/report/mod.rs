//! What was derived, in readable notation: the same lines as text and as LaTeX.

use guen_symbolic::{Class, ExprId, Notation};

use crate::derive::{Derived, function};
use crate::model::FormKind;

/// A heading with its lines.
pub struct Section {
    /// What the lines are.
    pub title: &'static str,
    /// The lines as text.
    pub text: Vec<String>,
    /// The same lines as LaTeX formulas, where they are formulas.
    pub latex: Vec<String>,
}

/// Everything that is told about a system.
pub struct Report {
    /// The system's name.
    pub name: String,
    /// One sentence.
    pub summary: String,
    /// The sections, in order.
    pub sections: Vec<Section>,
}

/// Coefficients with the names that they multiply.
type Terms = Vec<(ExprId, String)>;

/// What stands in place of a longer line.
const TOO_LONG: &str = ".. (too long to print)";

/// Lines longer than this are left to the programs.
const LONGEST: usize = 3000;

impl Report {
    /// Writes down what was derived.
    pub fn new(derived: &mut Derived<'_>) -> Self {
        let name = derived.model.declaration.name.text.clone();
        let brackets_found = bracket_terms(derived);
        let rows = equation_rows(derived);
        let derived = &*derived;
        // One memory for all sections: the parts of an expression are written once.
        let graph = &derived.model.bench.graph;
        let writer =
            &mut Writer { text: Notation::text(graph, LONGEST), latex: Notation::latex(graph, LONGEST) };
        let sections = vec![
            forms(derived, writer),
            operators(derived, writer),
            brackets(writer, &brackets_found),
            classification(derived, writer),
            velocities(derived, writer),
            equations(writer, &rows),
            momenta(derived, writer),
            energies(derived, writer),
            domain(derived),
            cost(derived),
        ];
        let (n, l) = (derived.model.coordinates.len(), derived.derivation.system.forms.degrees);
        let summary = format!(
            "{}, {}, {}: {}.",
            plural(n, "coordinate"),
            if l == 1 { "1 degree of freedom".to_owned() } else { format!("{l} degrees of freedom") },
            plural(n - l, "constraint"),
            class_name(derived.derivation.class),
        );
        Report { name, summary, sections: sections.into_iter().filter(|s| !s.text.is_empty()).collect() }
    }

    /// The whole report as text.
    pub fn to_text(&self) -> String {
        let mut text = format!("{}: {}\n", self.name, self.summary);
        for section in &self.sections {
            text.push_str(&format!("\n{}\n", section.title));
            for line in &section.text {
                text.push_str(&format!("  {line}\n"));
            }
        }
        text
    }
}

/// Both ways of writing.
struct Writer<'g> {
    text: Notation<'g>,
    latex: Notation<'g>,
}

/// Lines that are formulas, written twice.
struct Lines<'w, 'g> {
    writer: &'w mut Writer<'g>,
    section: Section,
}

impl<'w, 'g> Lines<'w, 'g> {
    fn new(writer: &'w mut Writer<'g>, title: &'static str) -> Self {
        Lines { writer, section: Section { title, text: Vec::new(), latex: Vec::new() } }
    }

    /// `left = right` with an expression on the right.
    fn equation(&mut self, left: &str, left_latex: &str, right: ExprId) {
        let text = self.writer.text.expression(right);
        let latex = self.writer.latex.expression(right);
        self.push(left, left_latex, text, latex);
    }

    /// `left = sum of coefficients times names`.
    fn combination(&mut self, left: &str, left_latex: &str, terms: &[(ExprId, String)]) {
        // Both sums take the plain names: LaTeX is made of them there.
        let terms: Vec<_> = terms.iter().map(|(c, name)| (*c, name.as_str())).collect();
        let text = self.writer.text.sum(&terms);
        let latex = self.writer.latex.sum(&terms);
        self.push(left, left_latex, text, latex);
    }

    fn push(&mut self, left: &str, left_latex: &str, text: Option<String>, latex: Option<String>) {
        self.section.text.push(format!("{left} = {}", text.as_deref().unwrap_or(TOO_LONG)));
        self.section.latex.push(format!("{left_latex} = {}", latex.as_deref().unwrap_or(r"\ldots")));
    }
}

fn latex_of(name: &str) -> String {
    guen_symbolic::latex_name(name)
}

fn forms(derived: &Derived<'_>, writer: &mut Writer<'_>) -> Section {
    let graph = &derived.model.bench.graph;
    let mut lines = Lines::new(writer, "Forms (1.1), (1.6)");
    let system = &derived.derivation.system;
    for (j, (entry, form)) in derived.model.forms.iter().zip(&system.forms.forms).enumerate() {
        let mut terms = Terms::new();
        for (a, x) in form.row.iter().zip(&system.velocities) {
            if !graph.is_zero(*a) {
                terms.push((*a, graph.text(*x)));
            }
        }
        let terms: Vec<_> = terms.iter().map(|(c, name)| (*c, name.as_str())).collect();
        let too_long = || TOO_LONG.to_owned();
        let mut text = lines.writer.text.sum(&terms).unwrap_or_else(too_long);
        let mut latex = lines.writer.latex.sum(&terms).unwrap_or_else(too_long);
        if !graph.is_zero(form.offset) {
            let offset = lines.writer.text.expression(form.offset).unwrap_or_else(too_long);
            text = format!("{text} + {offset}").replace("+ -", "- ");
            let offset = lines.writer.latex.expression(form.offset).unwrap_or_else(too_long);
            latex = format!("{latex} + {offset}").replace("+ -", "- ");
        }
        let zero = if j < system.forms.degrees { "" } else { " = 0" };
        let position = (entry.kind == FormKind::Holonomic)
            .then(|| system.holonomic.iter().find(|h| h.form == j))
            .flatten()
            .map(|h| format!("   (the rate of {} = 0)", graph.text(h.equation)))
            .unwrap_or_default();
        lines.section.text.push(format!("{} = {text}{zero}{position}", entry.name));
        lines.section.latex.push(format!("{} = {latex}{zero}", latex_of(&entry.name)));
    }
    for name in &derived.model.left_out {
        lines.section.text.push(format!("{name} is left out: it says 0 = 0"));
    }
    lines.section
}

fn operators(derived: &Derived<'_>, writer: &mut Writer<'_>) -> Section {
    let graph = &derived.model.bench.graph;
    let mut lines = Lines::new(writer, "Operators of displacement (1.4), (1.7)");
    for (j, xi) in derived.derivation.frame.operators.xi.iter().enumerate() {
        let mut terms = Terms::new();
        if j == 0 {
            terms.push((graph.one(), "d/dt".to_owned()));
        }
        for (c, x) in xi.iter().zip(&derived.derivation.system.forms.coordinates) {
            if !graph.is_zero(*c) {
                terms.push((*c, format!("d/d{}", graph.text(*x))));
            }
        }
        lines.combination(&format!("X{j}"), &format!("X_{{{j}}}"), &terms);
    }
    lines.section
}

/// The brackets with their coefficients; those that vanish have none.
fn bracket_terms(derived: &mut Derived<'_>) -> Vec<(usize, usize, Terms)> {
    let (n, l) = (derived.model.coordinates.len(), derived.derivation.system.forms.degrees);
    let mut found = Vec::new();
    for r in 0..=l {
        for s in r + 1..=l {
            let mut terms = Terms::new();
            for t in 1..=n {
                let c = derived.derivation.frame.brackets.coefficient(&mut derived.model.bench, r, s, t);
                if !derived.model.bench.graph.is_zero(c) {
                    terms.push((c, format!("X{t}")));
                }
            }
            found.push((r, s, terms));
        }
    }
    found
}

fn brackets(writer: &mut Writer<'_>, all: &[(usize, usize, Terms)]) -> Section {
    let mut lines = Lines::new(writer, "Brackets (1.14)");
    let (vanishing, found): (Vec<_>, Vec<_>) = all.iter().partition(|(_, _, terms)| terms.is_empty());
    let vanishing: Vec<(String, String)> = vanishing
        .into_iter()
        .map(|(r, s, _)| (format!("(X{r}, X{s})"), format!("(X_{{{r}}}, X_{{{s}}})")))
        .collect();
    for (r, s, terms) in &found {
        lines.combination(&format!("(X{r}, X{s})"), &format!("(X_{{{r}}}, X_{{{s}}})"), terms);
    }
    match (found.is_empty(), vanishing.len()) {
        (_, 0) => {}
        (true, _) => lines.section.text.push("all brackets vanish".to_owned()),
        (false, count) if count > 12 => lines.section.text.push("all others vanish".to_owned()),
        (false, _) => {
            let (text, latex): (Vec<_>, Vec<_>) = vanishing.into_iter().unzip();
            lines.section.text.push(format!("{} = 0", text.join(" = ")));
            lines.section.latex.push(format!("{} = 0", latex.join(" = ")));
        }
    }
    lines.section
}

/// The class in words.
pub(crate) fn class_name(class: Class) -> &'static str {
    match class {
        Class::LieGroup => "holonomic, a Lie group",
        Class::Holonomic => "holonomic, with variable coefficients",
        Class::IncompleteLieGroup => "nonholonomic, an incomplete Lie group",
        Class::Nonholonomic => "nonholonomic, with variable coefficients",
        Class::Undecided => "not classified",
    }
}

fn classification(derived: &Derived<'_>, writer: &mut Writer<'_>) -> Section {
    let d = &derived.derivation;
    let (n, l) = (derived.model.coordinates.len(), d.system.forms.degrees);
    let mut text = Vec::new();
    let growth: Vec<String> = d.closure.growth.iter().map(ToString::to_string).collect();
    let rank = d.closure.growth.last().copied().unwrap_or(l);
    text.push(format!("{}; growth vector ({})", class_name(d.class), growth.join(", ")));
    if d.closure.complete {
        text.push(if rank == l {
            format!("X0..X{l} are closed under the bracket: every constraint is integrable")
        } else {
            format!(
                "the iterated brackets of X0..X{l} have rank {} of {}, one more with time: {} of {} constraints integrable",
                rank,
                n,
                n - rank,
                n - l
            )
        });
    } else {
        text.push("the iterated brackets were not followed to the end".to_owned());
    }
    for combination in &d.closure.integrable {
        let known: Option<Vec<(ExprId, &str)>> = combination
            .terms
            .iter()
            .map(|(v, f)| f.map(|f| (f, derived.model.forms[*v].name.as_str())))
            .collect();
        let written = known.and_then(|terms| writer.text.sum(&terms)).unwrap_or_else(|| {
            let names: Vec<&str> =
                combination.terms.iter().map(|(v, _)| derived.model.forms[*v].name.as_str()).collect();
            format!("a combination of {}", names.join(", "))
        });
        text.push(format!("integrable: {written}"));
    }
    let yes =
        |holds: bool, what: &str, otherwise: &str| if holds { what.to_owned() } else { otherwise.to_owned() };
    text.push(
        [
            yes(d.scleronomic, "scleronomic", "rheonomic"),
            yes(d.catastatic, "catastatic", "acatastatic"),
            yes(d.conservative, "conservative", "not conservative"),
        ]
        .join(", "),
    );
    Section { title: "Classification", text, latex: Vec::new() }
}

fn velocities(derived: &Derived<'_>, writer: &mut Writer<'_>) -> Section {
    let mut lines = Lines::new(writer, "Velocities (1.8)");
    let system = &derived.derivation.system;
    for (x, value) in system.velocities.iter().zip(&derived.derivation.frame.velocities) {
        let name = derived.model.bench.graph.text(*x);
        lines.equation(&name, &latex_of(&name), *value);
    }
    lines.section
}

/// The left sides of the equations of motion.
fn equation_rows(derived: &mut Derived<'_>) -> Vec<ExprId> {
    let graph = &mut derived.model.bench.graph;
    let d = &derived.derivation;
    d.equations
        .mass
        .iter()
        .zip(&d.equations.forces)
        .map(|(row, force)| {
            let mut terms: Vec<ExprId> =
                row.iter().zip(&d.system.accelerations).map(|(m, a)| graph.mul(*m, *a)).collect();
            terms.push(graph.neg(*force));
            graph.sum(terms)
        })
        .collect()
}

fn equations(writer: &mut Writer<'_>, rows: &[ExprId]) -> Section {
    let mut section = Section { title: "Equations of motion (2.7)", text: Vec::new(), latex: Vec::new() };
    for row in rows {
        match (writer.text.expression(*row), writer.latex.expression(*row)) {
            (Some(text), Some(latex)) => {
                section.text.push(format!("{text} = 0"));
                section.latex.push(format!("{latex} = 0"));
            }
            _ => section.text.push(TOO_LONG.to_owned()),
        }
    }
    section
}

fn momenta(derived: &Derived<'_>, writer: &mut Writer<'_>) -> Section {
    let mut lines = Lines::new(writer, "Momenta (2.8)");
    let l = derived.derivation.system.forms.degrees;
    for (j, momentum) in derived.derivation.energies.momenta.iter().enumerate() {
        let name = &derived.model.forms[j].name;
        if !derived.derivation.known_momentum[j] {
            lines.section.text.push(format!("(dT°/d{name}) is unknown: T is given on the constraints"));
            continue;
        }
        let (left, latex) = if j < l {
            (format!("dT/d{name}"), format!(r"\frac{{\partial T}}{{\partial {}}}", latex_of(name)))
        } else {
            (
                format!("(dT°/d{name})"),
                format!(r"\left(\frac{{\partial T^\circ}}{{\partial {}}}\right)", latex_of(name)),
            )
        };
        lines.equation(&left, &latex, *momentum);
    }
    lines.section
}

fn energies(derived: &Derived<'_>, writer: &mut Writer<'_>) -> Section {
    let mut lines = Lines::new(writer, "Energies");
    let d = &derived.derivation;
    lines.equation("T", "T", d.energies.kinetic);
    lines.equation("U", "U", d.system.force_function);
    lines.equation("h", "h", d.energies.integral);
    if !d.conservative {
        lines.equation("h'", r"\dot h", d.power);
    }
    lines.section
}

fn domain(derived: &Derived<'_>) -> Section {
    let graph = &derived.model.bench.graph;
    let nonzero = |e: &ExprId| graph.text_limited(*e, LONGEST).map(|text| format!("{text} != 0"));
    let state = derived.domain_names.iter().map(|text| format!("{text} != 0"));
    let text = state.chain(derived.constant_pivots.iter().filter_map(nonzero)).collect();
    Section { title: "Domain of the chart", text, latex: Vec::new() }
}

fn cost(derived: &Derived<'_>) -> Section {
    let mut text = Vec::new();
    if let Some(rhs) = derived.programs.functions.iter().find(|f| f.name == function::RHS) {
        text.push(format!("right-hand side: {}", operations(&rhs.cost)));
    }
    text.push(format!("prepared once: {}", operations(&derived.programs.prepare_cost)));
    Section { title: "Cost", text, latex: Vec::new() }
}

fn operations(count: &guen_symbolic::OperationCount) -> String {
    let parts: Vec<String> = [
        (count.additions, "addition"),
        (count.negations, "negation"),
        (count.multiplications, "multiplication"),
        (count.divisions, "division"),
        (count.roots, "root"),
        (count.sines, "sine and cosine pair"),
        (count.calls, "other call"),
    ]
    .into_iter()
    .filter(|(number, _)| *number > 0)
    .map(|(number, name)| plural(number as usize, name))
    .collect();
    let all = plural((count.operations() + count.sines + count.calls) as usize, "operation");
    if parts.is_empty() { all } else { format!("{all}: {}", parts.join(", ")) }
}

fn plural(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

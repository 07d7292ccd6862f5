//! The derivation in readable notation: the same lines as text and as LaTeX.

mod contacts;
mod interface;
mod lines;
mod mathml;
mod pages;
mod reasons;
mod scene;

pub(crate) use contacts::row_name;
pub(crate) use interface::interface;
pub use lines::{ReportLines, SectionLines};
pub(crate) use pages::page;
pub use pages::set;

use guen_symbolic::{ExprId, Notation};

use crate::derive::{DerivedLevel, MissingBounds, Subject, function};
use crate::model::{ChosenRates, FormKind, Model, RedundantEntry};
use lines::{LATEX_TOO_LONG, Lines, TOO_LONG, Terms, Writer, class_name, plural};

/// Lines longer than this are left to the programs.
const LINE_CHARACTERS: usize = 3000;

/// The limit of lines where a system has more than [`MANY_LINES`] parameters: its report has a line for each.
const LINE_CHARACTERS_OF_MANY: usize = 500;

/// The number of parameters above which long lines are left to the programs earlier, and sections are cut.
const MANY_LINES: usize = 24;

/// The lines that a section of such a report has at most, the line about those that are left out beside.
const LINES_OF_A_SECTION: usize = 48;

impl ReportLines {
    /// Writes down what was derived of a level of detail of a model.
    pub fn of(model: &Model<'_>, level: &DerivedLevel) -> Self {
        ReportLines::of_part(model, level, model)
    }

    /// Writes down what was derived of a scene whose mode makes it a part of another system, as [`DerivedSystem::in_modes`] has it.
    ///
    /// [`DerivedSystem::in_modes`]: crate::derive::DerivedSystem::in_modes
    pub fn of_part(model: &Model<'_>, level: &DerivedLevel, whole: &Model<'_>) -> Self {
        ReportLines::new(&Subject { model, level, whole })
    }

    /// Writes down what was derived of a level of detail.
    pub(crate) fn new(subject: &Subject<'_, '_>) -> Self {
        let selection = &subject.level.selection;
        // One memory for all sections: the parts of an expression are written once.
        let graph = &subject.model.bench.graph;
        let shown = &subject.level.shown;
        let is_long = subject.level.derivation.system.forms.degrees > MANY_LINES;
        let characters = if is_long { LINE_CHARACTERS_OF_MANY } else { LINE_CHARACTERS };
        let writer = &mut Writer {
            text: Notation::text(graph, characters).of_images(shown),
            latex: Notation::latex(graph, characters).of_images(shown),
        };
        let operators = |lines: &mut Vec<SectionLines>, writer: &mut Writer<'_>| {
            lines.push(self::operators(subject, writer));
            lines.push(self::brackets(subject, writer));
        };
        let mut sections = Vec::new();
        if subject.level.scene.is_some() {
            sections.extend(scene::sections(subject));
            if selection.operators {
                operators(&mut sections, writer);
            }
            sections.push(classification(subject, writer));
            sections.push(scene::rates(subject, writer));
            sections.extend(contacts::section(subject, writer));
            if selection.energy {
                sections.push(scene::energy(subject, writer));
            }
        } else {
            sections.extend(pages::declared(subject));
            sections.push(forms(subject, writer));
            operators(&mut sections, writer);
            sections.push(classification(subject, writer));
            sections.push(velocities(subject, writer));
            sections.push(equations(subject, writer));
            sections.push(states(subject, writer));
            sections.push(momenta(subject, writer));
            sections.push(energies(subject, writer));
            sections.extend(contacts::section(subject, writer));
        }
        sections.push(domain(subject, writer));
        sections.push(edges(subject));
        sections.push(cost(subject));
        let summary = if subject.level.scene.is_some() { scene::summary(subject) } else { summary(subject) };
        if is_long {
            sections.iter_mut().for_each(SectionLines::shorten);
        }
        let name = subject.name().text.clone();
        ReportLines { name, summary, sections: sections.into_iter().filter(|s| !s.text.is_empty()).collect() }
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

impl SectionLines {
    /// Cuts a section behind its first lines, and says how many more there are.
    fn shorten(&mut self) {
        let left_out = |lines: &mut Vec<String>, note: fn(usize) -> String| {
            if lines.len() > LINES_OF_A_SECTION {
                let more = lines.len() - LINES_OF_A_SECTION;
                lines.truncate(LINES_OF_A_SECTION);
                lines.push(note(more));
            }
        };
        left_out(&mut self.text, |more| format!("and {more} more"));
        left_out(&mut self.latex, |more| format!(r"\text{{and {more} more}}"));
    }
}

fn summary(subject: &Subject<'_, '_>) -> String {
    let derivation = &subject.level.derivation;
    let (n, l) = (subject.model.coordinates.len(), derivation.system.forms.degrees);
    let states = match subject.model.states.len() {
        0 => String::new(),
        count => format!(", {}", plural(count, "state")),
    };
    format!(
        "{}, {}, {}{states}: {}.",
        plural(n, "coordinate"),
        if l == 1 { "1 degree of freedom".to_owned() } else { format!("{l} degrees of freedom") },
        plural(n - l, "constraint"),
        class_name(derivation.class),
    )
}

fn forms(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let graph = &subject.model.bench.graph;
    let mut lines = Lines::new(writer, "Forms (1.1), (1.6)");
    let system = &subject.level.derivation.system;
    for (j, (entry, form)) in subject.model.forms.iter().zip(&system.forms.forms).enumerate() {
        let mut terms = Terms::new();
        for (a, x) in form.row.iter().zip(&system.velocities) {
            if !graph.is_zero(*a) {
                terms.push((*a, graph.text(*x)));
            }
        }
        let terms: Vec<_> = terms.iter().map(|(c, name)| (*c, name.as_str())).collect();
        let Writer { text, latex } = &mut *lines.writer;
        let zero = if j < system.forms.degrees { "" } else { " = 0" };
        let or_too_long = |written: Option<String>, note: &str| written.unwrap_or_else(|| note.to_owned());
        let (own, sum) = (&entry.name, or_too_long(text.affine(&terms, form.offset), TOO_LONG));
        let mut line = format!("{own} = {sum}{zero}");
        let (own, sum) =
            (latex.name(&entry.name), or_too_long(latex.affine(&terms, form.offset), LATEX_TOO_LONG));
        let mut formula = format!("{own} = {sum}{zero}");
        let holonomic = system.holonomic.iter().find(|h| h.form == j);
        if let Some(position) = holonomic.filter(|_| entry.kind == FormKind::Holonomic) {
            let equation = or_too_long(text.expression(position.equation), TOO_LONG);
            line.push_str(&format!("   (the rate of {equation} = 0)"));
            let equation = or_too_long(latex.expression(position.equation), LATEX_TOO_LONG);
            formula.push_str(&format!(r"\quad\text{{(the rate of }}{equation} = 0\text{{)}}"));
        }
        lines.section.text.push(line);
        lines.section.latex.push(formula);
    }
    lines.section.text.extend(subject.model.chosen.as_ref().map(chosen));
    for name in &subject.model.left_out {
        lines.section.text.push(format!("{name} is left out: it says 0 = 0"));
    }
    for body in subject.model.bodies.iter().filter(|body| body.is_impossible) {
        let name = &body.name;
        lines.section.text.push(format!(
            "the inertia of {name} is that of no body: a principal moment is negative, or exceeds the sum of the others"
        ));
    }
    for body in
        subject.model.bodies.iter().filter(|body| body.mass.is_some_and(|m| subject.model.is_negative(m)))
    {
        lines.section.text.push(format!("the mass of {} is negative", body.name));
    }
    for redundant in &subject.model.redundant {
        let (name, others) = (&redundant.entry.name, beside(subject.model, redundant));
        lines.section.text.push(format!(
            "{name} is no form: it follows from {others} wherever all hold, as points of them show; only the sum of their \
             reactions is determined, and those of {others} are given for none of {name}"
        ));
    }
    lines.section
}

/// The line about the parameters that the macro chose, with its reason.
fn chosen(chosen: &ChosenRates) -> String {
    let ChosenRates { names, condition, best: (best, least) } = chosen;
    let (own, are) = (listed(names), if names.len() == 1 { "is" } else { "are" });
    if condition.to_bits() == 1.0_f64.to_bits() {
        return format!("{own} {are} chosen by the macro: the rates that no form given binds");
    }
    let measure = "sqrt(1 + |T|^2) of the matrix T that gives the other velocities by the chosen ones, at the worst of 64 states";
    if names == best {
        return format!(
            "{own} {are} chosen by the macro: no rates of coordinates have a better condition, {condition:.3}, {measure}"
        );
    }
    format!(
        "{own} {are} chosen by the macro: the first rates of coordinates whose condition is within ten times the best, {condition:.3} \
         beside {least:.3} of {}; {measure}",
        listed(best)
    )
}

/// `a, b and c`.
fn listed(names: &[String]) -> String {
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}

/// The equations that another follows from.
fn beside(model: &Model<'_>, redundant: &RedundantEntry<'_>) -> String {
    let names: Vec<String> = redundant.beside.iter().map(|form| model.forms[*form].name.clone()).collect();
    if names.is_empty() { "the others".to_owned() } else { listed(&names) }
}

fn operators(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let graph = &subject.model.bench.graph;
    let mut lines = Lines::new(writer, "Operators of displacement (1.4), (1.7)");
    for (j, xi) in subject.level.derivation.frame.operators.xi.iter().enumerate() {
        let mut terms = Terms::new();
        if j == 0 {
            terms.push((graph.one(), "d/dt".to_owned()));
        }
        for (c, x) in xi.iter().zip(&subject.level.derivation.system.forms.coordinates) {
            if !graph.is_zero(*c) {
                terms.push((*c, format!("d/d{}", graph.text(*x))));
            }
        }
        lines.combination(&format!("X{j}"), &format!("X_{{{j}}}"), &terms);
    }
    lines.section
}

fn brackets(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let graph = &subject.model.bench.graph;
    let last = subject.model.last_operator();
    let mut found: Vec<(usize, usize, Terms)> = Vec::new();
    let mut vanishing = Vec::new();
    for r in 0..=last {
        for s in r + 1..=last {
            let bracket = subject.level.brackets.iter().find(|bracket| (bracket.r, bracket.s) == (r, s));
            let coefficients = bracket.map_or(&[][..], |bracket| &bracket.coefficients);
            let terms = coefficients.iter().enumerate().filter(|(_, c)| !graph.is_zero(**c));
            let terms: Terms = terms.map(|(t, c)| (*c, format!("X{}", t + 1))).collect();
            if terms.is_empty() {
                vanishing.push((format!("(X{r}, X{s})"), format!("(X_{{{r}}}, X_{{{s}}})")));
            } else {
                found.push((r, s, terms));
            }
        }
    }
    let mut lines = Lines::new(writer, "Brackets (1.14)");
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

fn classification(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let d = &subject.level.derivation;
    let (n, l) = (subject.model.coordinates.len(), d.system.forms.degrees);
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
            .map(|(v, f)| f.map(|f| (f, subject.model.forms[*v].name.as_str())))
            .collect();
        let written = known.and_then(|terms| writer.text.sum(&terms)).unwrap_or_else(|| {
            let names: Vec<&str> =
                combination.terms.iter().map(|(v, _)| subject.model.forms[*v].name.as_str()).collect();
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
    text.extend(reasons::of(subject));
    text.extend(in_c(subject.level));
    SectionLines::words("Classification", text)
}

/// The steppers that the text of C does not have, and why.
fn in_c(level: &DerivedLevel) -> Option<String> {
    if !level.provides_source || level.steps_adapt_in_c() {
        return None;
    }
    Some(if level.steps_in_c() {
        let switches: Vec<String> = level.switches.iter().map(|switch| format!("`{switch}`")).collect();
        format!(
            "no DOP853 in the text of C: its steps would have to begin anew at the zeros of {}",
            switches.join(", ")
        )
    } else {
        "no steppers in the text of C: constraints of positions would have to be restored after steps"
            .to_owned()
    })
}

fn velocities(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let mut lines = Lines::new(writer, "Velocities (1.8)");
    let system = &subject.level.derivation.system;
    for (x, value) in system.velocities.iter().zip(&subject.level.derivation.frame.velocities) {
        let name = subject.model.bench.graph.text(*x);
        lines.named(&name, *value);
    }
    lines.section
}

fn equations(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let mut section =
        SectionLines { title: "Equations of motion (2.7)", text: Vec::new(), latex: Vec::new() };
    if !subject.level.derivation.is_written_out() {
        let l = subject.level.derivation.system.forms.degrees;
        section.text.push(format!(
            "not written out: of {l} parameters the mass matrix has {} entries. There are neither `mass_form`, `mass_matrix` and what \
             takes these nor `momenta`",
            l * l
        ));
    }
    for row in &subject.level.equations {
        match (writer.text.expression(*row), writer.latex.expression(*row)) {
            (Some(text), Some(latex)) => {
                section.text.push(format!("{text} = 0"));
                section.latex.push(format!("{latex} = 0"));
            }
            _ => {
                section.text.push(format!("{TOO_LONG} = 0"));
                section.latex.push(format!("{LATEX_TOO_LONG} = 0"));
            }
        }
    }
    section
}

/// The rates of the states beside the motion.
fn states(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let Subject { model, level, .. } = subject;
    let mut lines = Lines::new(writer, "Rates of the states");
    let first = level.rates.len() - model.states.len();
    for (state, rate) in model.states.iter().zip(&level.rates[first..]) {
        lines.named(&format!("{}'", state.name), *rate);
    }
    lines.section
}

fn momenta(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let mut lines = Lines::new(writer, "Momenta (2.8)");
    let l = subject.level.derivation.system.forms.degrees;
    let mut unknown = Vec::new();
    for (j, momentum) in subject.level.derivation.energies.momenta.iter().enumerate() {
        let name = &subject.model.forms[j].name;
        if !subject.level.derivation.known_momentum[j] {
            unknown.push(format!("(dT°/d{name}) is unknown: T is given on the constraints"));
            continue;
        }
        let set = lines.writer.latex.name(name);
        let (left, latex) = if j < l {
            (format!("dT/d{name}"), format!(r"\frac{{\partial T}}{{\partial {set}}}"))
        } else {
            let latex = format!(r"\left(\frac{{\partial T^\circ}}{{\partial {set}}}\right)");
            (format!("(dT°/d{name})"), latex)
        };
        lines.equation(&left, &latex, *momentum);
    }
    lines.section.text.extend(unknown);
    lines.section
}

fn energies(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let mut lines = Lines::new(writer, "Energies");
    let d = &subject.level.derivation;
    lines.equation("T", "T", d.energies.kinetic);
    lines.equation("U", "U", d.system.force_function);
    lines.equation("h", "h", d.energies.integral);
    if !d.conservative {
        lines.equation("h'", r"\dot h", d.power);
    }
    lines.section
}

/// The functions that must not vanish: formulas, then those that are told in words.
fn domain(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let (mut formulas, mut words) = (Vec::new(), Vec::new());
    for (e, name) in subject.level.domain.iter().zip(&subject.level.domain_names) {
        match writer.text.expression(*e) {
            Some(text) if text == *name => formulas.push(*e),
            _ => words.push(format!("{name} != 0")),
        }
    }
    let mut section = SectionLines::words("Domain of the chart", Vec::new());
    for e in formulas.iter().chain(&subject.level.constant_pivots) {
        if let (Some(text), Some(latex)) = (writer.text.expression(*e), writer.latex.expression(*e)) {
            section.text.push(format!("{text} != 0"));
            section.latex.push(format!(r"{latex} \neq 0"));
        }
    }
    section.text.extend(words);
    if subject.level.program(function::MASS).is_some() {
        section.text.push(
            "the mass matrix M is regular; `condition`, max_s M_ss (M^-1)_ss, says by how much".to_owned(),
        );
    }
    section
}

/// The section on the edges of the chart: the origin of each function, and the states at which it vanishes.
fn edges(subject: &Subject<'_, '_>) -> SectionLines {
    let edges = subject.level.domain_names.iter().zip(&subject.level.domain_reasons);
    SectionLines::words(
        "Edges of the chart",
        edges.map(|(name, reason)| format!("`{name}`: {reason}")).collect(),
    )
}

fn cost(subject: &Subject<'_, '_>) -> SectionLines {
    let mut text = Vec::new();
    if let Some(rhs) = subject.level.program(function::RHS) {
        text.push(format!("right-hand side: {}", operations(&rhs.cost)));
    }
    text.push(format!("prepared once: {}", operations(&subject.level.programs.prepare_cost)));
    if let Some(MissingBounds { constants, saved }) = &subject.level.missing_bounds {
        let constants: Vec<String> = constants.iter().map(|name| format!("`{name} != 0`")).collect();
        let saved = saved.map_or("fewer operations, perhaps".to_owned(), |saved| {
            format!("{} less", plural(saved as usize, "operation"))
        });
        text.push(format!("declare {}: {saved}", constants.join(", ")));
    }
    SectionLines::words("Cost", text)
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

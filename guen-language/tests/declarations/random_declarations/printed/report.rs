//! A report as it is printed, and what each of its lines has to say.

use std::fmt::{self, Display, Formatter};

use guen_language::derive::{DerivedLevel, DerivedSystem, derive};
use guen_language::diagnostics::collect;
use guen_language::model::{FormKind, Model};
use guen_language::report::{ReportLines, SectionLines};
use guen_language::{emit, model, parse};
use guen_symbolic::{ExprId, Role};

use super::lines::{Format, Found, Line, check, long, same};
use super::names::{Name, Scope};
use super::{pages, text};

/// What was found in reports.
#[derive(Default)]
pub struct Checked {
    reports: usize,
    wrong: usize,
    lines: usize,
    long: usize,
    faults: Vec<String>,
}

impl Checked {
    pub fn add(&mut self, other: Checked) {
        self.reports += other.reports;
        self.wrong += other.wrong;
        self.lines += other.lines;
        self.long += other.long;
        self.faults.extend(other.faults);
    }

    fn line(&mut self, found: Result<Found, String>, place: &str, line: &str) {
        self.lines += 1;
        match found {
            Ok(Found::Same) => {}
            Ok(Found::TooLong) => self.long += 1,
            Err(why) => self.faults.push(format!("{place}: {why}\n  {line}")),
        }
    }

    pub fn assert(&self) {
        for fault in self.faults.iter().take(40) {
            println!("{fault}\n");
        }
        assert!(self.faults.is_empty(), "{self}");
        assert!(self.lines > 20 * self.reports && self.long < self.lines / 3, "{self}");
    }
}

impl Display for Checked {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Checked { reports, wrong, lines, long, faults } = self;
        write!(
            f,
            "{wrong} of {reports} reports wrong; {} of {lines} lines, {long} too long to print",
            faults.len()
        )
    }
}

/// Checks the reports of a declaration and of its scenes, and the signatures of its outline if asked for; none where something is
/// wrong in it.
pub fn checked(text: &str, with_outline: bool) -> Option<Checked> {
    let (declaration, faults) = parse::parse(text.parse().expect("tokens"));
    let declaration = declaration.filter(|_| faults.is_empty())?;
    let (derived, faults) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults));
    let DerivedSystem { mut model, system, scenes, in_modes } = derived.filter(|_| faults.is_empty())?;
    let mut all = Checked::default();
    for level in [&system].into_iter().chain(&scenes) {
        let mut own = level_checked(&mut model, level);
        own.reports = 1;
        own.wrong = usize::from(!own.faults.is_empty());
        for fault in &mut own.faults {
            fault.insert_str(0, &format!("{}: ", declaration.name));
        }
        all.add(own);
    }
    // An outline has as many forms as coordinates: which constraints follow from others the derivation alone knows.
    if with_outline && model.redundant.is_empty() {
        // That a linearisation is too long to be code is not known before it is derived.
        let is_code = system.jacobians.rates.is_some();
        let linearized = |item: &String| item.contains("fn linearize") || item.contains("differentiable !");
        let (is_chosen, has_units) = (model.chosen.is_some(), !model.units.is_empty());
        let is_in_modes = !in_modes.is_empty();
        let has_branches = system.contacts.as_ref().is_some_and(|facts| !facts.branches.is_empty());
        let has_switches = [&system].into_iter().chain(&scenes).any(|level| !level.switches.is_empty());
        let names: Vec<String> = model.forms.iter().map(|form| form.name.clone()).collect();
        let has = |whole: &str, axis: &str| names.contains(&format!("{whole}_{axis}"));
        let is_without_first_or_second = |item: &String| {
            let field = item.rsplit(' ').next().and_then(|field| field.strip_suffix("_z"));
            field.is_some_and(|whole| has(whole, "x") != has(whole, "y"))
        };
        let items = emit::emit(DerivedSystem { model, system, scenes, in_modes });
        let missing = crate::outline::missing(&declaration, items).into_iter();
        let missing = missing.filter(|item| is_code || !linearized(item));
        // An outline has no units.
        let with_units = |item: &String| {
            ["simulated !", "output_map !", "structured !"].iter().any(|word| item.contains(word))
        };
        let missing = missing.filter(|item| !has_units || !with_units(item));
        // Nor is it known which rates of coordinates complete the parameters.
        let missing = missing.filter(|item| !is_chosen || !item.contains("_rate"));
        // Nor which component of a vector says `0 = 0`: it has the first two.
        let missing = missing.filter(|item| !is_without_first_or_second(item));
        // Nor how many zeros change the formula of the rates.
        let missing = missing.filter(|item| !has_switches || !item.contains("const SWITCHES"));
        // Nor which rows of a mode depend on others, and which of them belong to instances.
        let with_rows = |item: &String| {
            let of_rows = [
                "reactions !",
                " Reactions <",
                "fn residuals",
                ":: Positions <",
                "residuals !",
                ":: Ordered >",
            ];
            of_rows.iter().any(|word| item.contains(word))
        };
        let missing = missing.filter(|item| !is_in_modes || !with_rows(item));
        // Nor how many branches of piecewise functions are held in a mode.
        let with_signals = |item: &String| {
            [
                "simulated_through_modes !",
                "hybrid :: InMode <",
                "hybrid :: HybridSystem <",
                "hybrid :: ActuatedModes <",
            ]
            .iter()
            .any(|word| item.contains(word))
        };
        let missing = missing.filter(|item| !has_branches || !with_signals(item));
        all.faults.extend(missing.map(|item| format!("{}: not in the outline: {item}", declaration.name)));
    }
    Some(all)
}

fn level_checked(model: &mut Model<'_>, level: &DerivedLevel) -> Checked {
    let report = ReportLines::of(model, level);
    let pi = model.bench.graph.pi();
    let mut scope = scope(model, level);
    scope.add("pi", pi);
    let mut found = Checked::default();
    for section in &report.sections {
        let title = section.title;
        let Some(expected) = expected(model, level, section, &mut scope) else { continue };
        // Formulas of some sections stand among words.
        let plain: Vec<&String> = match title {
            "Classification" => {
                let is_formula =
                    |line: &&String| line.starts_with(INTEGRABLE) && !line.contains("a combination of");
                section.text.iter().filter(is_formula).collect()
            }
            _ => section.text.iter().collect(),
        };
        let set: Vec<&String> = section.latex.iter().collect();
        for (format, lines) in [(Format::Text, &plain), (Format::Latex, &set), (Format::MathMl, &set)] {
            if format != Format::Text && lines.is_empty() {
                continue;
            }
            let (lines, more) = without_note(lines);
            assert!(lines.len() + more >= expected.len(), "lines of {title}");
            for (line, expected) in lines.iter().zip(&expected) {
                let mut own = check(line, format, expected, &mut model.bench, &scope);
                if own == Ok(Found::TooLong) {
                    own = long(expected, format, &mut model.bench, &scope);
                }
                found.line(own, &format!("{title}, {format:?}"), line);
            }
        }
    }
    for (e, name) in level.domain.iter().zip(&level.domain_names) {
        let is_word = ["det M[", "a factor of", "a pivot of"].iter().any(|word| name.starts_with(word));
        if !is_word {
            let own = text::read(name).and_then(|term| same(&term, *e, &mut model.bench, &scope));
            found.line(own.map(|()| Found::Same), "DOMAIN", name);
        }
    }
    found.faults.extend(pages::faults(&report));
    found
}

/// The lines of a section without the note behind those of a long one, and how many more the note says there are.
fn without_note<'a, 'b>(lines: &'a [&'b String]) -> (&'a [&'b String], usize) {
    let told = |line: &str| {
        let words = line.trim_start_matches(r"\text{").trim_end_matches('}');
        words.strip_prefix("and ")?.strip_suffix(" more")?.parse().ok()
    };
    match lines.split_last().and_then(|(last, before)| Some((before, told(last)?))) {
        Some(cut) => cut,
        None => (lines, 0),
    }
}

/// What stands before the integrable combinations of constraints.
const INTEGRABLE: &str = "integrable: ";

/// The names of a level.
fn scope(model: &Model<'_>, level: &DerivedLevel) -> Scope {
    let mut scope = Scope::default();
    let graph = &model.bench.graph;
    let mechanics = &level.derivation.system;
    let all = model.constants.iter().map(|c| c.symbol).chain(mechanics.inputs.iter().copied());
    let all = all.chain(mechanics.forms.coordinates.iter().copied()).chain([mechanics.forms.time]);
    let all = all.chain(mechanics.states.iter().map(|state| state.symbol));
    for e in all.chain(mechanics.velocities.iter().copied()).chain(mechanics.etas.iter().copied()) {
        let symbol = graph.as_symbol(e).expect("a symbol");
        scope.add(&graph.symbol_info(symbol).name, e);
    }
    for (form, e) in model.forms.iter().zip(&mechanics.accelerations) {
        scope.add(&format!("{}'", form.name), *e);
    }
    for held in &level.selection.held {
        scope.add(model.variable_name(held.place), held.symbol);
    }
    scope
}

/// A symbol for something that has a name and is no expression.
fn unknown(model: &mut Model<'_>, scope: &mut Scope, name: &str) -> ExprId {
    if let Ok(known) = scope.symbol(&Name::Text(name.to_owned())) {
        return known;
    }
    let symbol = model.bench.graph.symbol(name, Role::Input);
    scope.add(name, symbol);
    symbol
}

/// What the lines of a section have to say, in order; none for sections of words.
fn expected(
    model: &mut Model<'_>,
    level: &DerivedLevel,
    section: &SectionLines,
    scope: &mut Scope,
) -> Option<Vec<Line>> {
    let d = &level.derivation;
    let (system, l) = (&d.system, d.system.forms.degrees);
    let equation =
        |label: String, value: ExprId| Line::Equation { label, value, vanishes: false, rate_of: None };
    let mut lines = Vec::new();
    match section.title.split(' ').next().expect("a word") {
        "Forms" => {
            for (j, form) in system.forms.forms.iter().enumerate() {
                let linear = model.bench.dot(&form.row, &system.velocities);
                let is_holonomic = model.forms[j].kind == FormKind::Holonomic;
                let position = system.holonomic.iter().find(|h| h.form == j && is_holonomic);
                lines.push(Line::Equation {
                    label: model.forms[j].name.clone(),
                    value: model.bench.graph.add(linear, form.offset),
                    vanishes: j >= l,
                    rate_of: position.map(|h| h.equation),
                });
            }
        }
        "Operators" => {
            let names: Vec<String> = model.coordinates.iter().map(|entry| entry.name.text.clone()).collect();
            for (j, xi) in d.frame.operators.xi.iter().enumerate() {
                let mut terms = Vec::new();
                if j == 0 {
                    terms.push(unknown(model, scope, "d/dt"));
                }
                for (c, name) in xi.iter().zip(&names) {
                    let partial = unknown(model, scope, &format!("d/d{name}"));
                    terms.push(model.bench.graph.mul(*c, partial));
                }
                lines.push(equation(format!("X{j}"), model.bench.graph.sum(terms)));
            }
        }
        "Brackets" => {
            let last = model.last_operator();
            let mut vanishing = Vec::new();
            for (r, s) in (0..=last).flat_map(|r| (r + 1..=last).map(move |s| (r, s))) {
                let label = format!("(X{r}, X{s})");
                let bracket = level.brackets.iter().find(|bracket| (bracket.r, bracket.s) == (r, s));
                let Some(bracket) = bracket else {
                    vanishing.push(label);
                    continue;
                };
                let mut terms = Vec::new();
                for (t, c) in bracket.coefficients.iter().enumerate() {
                    let operator = unknown(model, scope, &format!("X{}", t + 1));
                    terms.push(model.bench.graph.mul(*c, operator));
                }
                lines.push(equation(label, model.bench.graph.sum(terms)));
            }
            // Many are told in words.
            let words = section.text.last().map(String::as_str);
            if !vanishing.is_empty() && !matches!(words, Some("all brackets vanish" | "all others vanish")) {
                lines.push(Line::All(vanishing));
            }
        }
        "Classification" => {
            for combination in &d.closure.integrable {
                let terms = combination.terms.iter();
                let terms: Option<Vec<ExprId>> =
                    terms.map(|(v, f)| f.map(|f| model.bench.graph.mul(f, system.etas[*v]))).collect();
                if let Some(terms) = terms {
                    lines.push(Line::Behind(INTEGRABLE, model.bench.graph.sum(terms)));
                }
            }
        }
        "Velocities" => {
            for (x, value) in system.velocities.iter().zip(&d.frame.velocities) {
                lines.push(equation(model.bench.graph.text(*x), *value));
            }
        }
        "Equations" => lines.extend(level.equations.iter().map(|e| Line::Vanishes(*e))),
        "Momenta" => {
            for (j, momentum) in d.energies.momenta.iter().enumerate().filter(|(j, _)| d.known_momentum[*j]) {
                let name = &model.forms[j].name;
                let label = if j < l { format!("dT/d{name}") } else { format!("(dT°/d{name})") };
                lines.push(equation(label, *momentum));
            }
        }
        "Energies" if level.scene.is_some() => lines.push(equation("h".to_owned(), level.energy)),
        "Energies" => {
            lines.push(equation("T".to_owned(), d.energies.kinetic));
            lines.push(equation("U".to_owned(), system.force_function));
            lines.push(equation("h".to_owned(), d.energies.integral));
            if !d.conservative {
                lines.push(equation("h'".to_owned(), d.power));
            }
        }
        "Rates" if level.scene.is_none() => {
            let first = model.coordinates.len() + l;
            for (state, rate) in model.states.iter().zip(&level.rates[first..]) {
                lines.push(equation(format!("{}'", state.name), *rate));
            }
        }
        "Rates" => {
            for (place, rate) in level.selection.variables.iter().zip(&level.rates) {
                lines.push(equation(format!("{}'", model.variable_name(*place)), *rate));
            }
        }
        "Domain" => {
            let mut all = level.domain.iter().zip(&level.domain_names);
            for line in &section.text[..section.latex.len()] {
                match all.find(|(_, name)| *line == format!("{name} != 0")) {
                    Some((e, _)) => lines.push(Line::Differs(*e)),
                    None => break,
                }
            }
            lines.extend(level.constant_pivots.iter().map(|e| Line::Differs(*e)));
        }
        "Constants" => {
            for (c, value) in level.scene.iter().flat_map(|facts| &facts.fixes) {
                lines.push(equation(model.constants[*c].name.text.clone(), *value));
            }
        }
        _ => return None,
    }
    Some(lines)
}

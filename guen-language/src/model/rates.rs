//! Parameters that may be left out: rates of coordinates, `<coordinate>_rate`, chosen once all forms are known.
//!
//! A declaration may use such a name before that, and names that were used and not chosen are reported then.

use std::collections::BTreeMap;

use guen_symbolic::{ExprId, Form, Graph, Role, SymbolId, chosen_rates, evaluate_f64};

use super::assumed_rates::Assumed;
use super::evaluate::Evaluator;
use super::forms::RawForm;
use super::scope::Category;
use super::value::Value;
use super::{ConstantEntry, FormEntry, FormKind, SymbolEntry};
use crate::diagnostics::Fault;
use crate::names::{RATE_SUFFIX, quoted, suffixed, without_suffix};
use crate::syntax::{Docs, Name};

/// No documentation: that of the coordinate is about the coordinate.
const UNDOCUMENTED: &Docs = &Docs { values: Vec::new(), lines: Vec::new() };

/// The parameters that were chosen, with the reason.
pub struct ChosenRates {
    /// The names of the parameters.
    pub names: Vec<String>,
    /// The condition of this set at the worst of the states.
    pub condition: f64,
    /// The best condition of a set of rates, and the names of that set.
    pub best: (Vec<String>, f64),
}

impl Evaluator<'_> {
    /// The rate of a coordinate that is used as a parameter, unless the name is declared.
    pub(super) fn assumed_rate(&mut self, name: &Name) -> Option<Value> {
        if self.scope.is_announced(&name.text) {
            return None;
        }
        if let Some(assumed) = self.rates.0.get(&name.text) {
            return Some(Value::Scalar(assumed.symbol));
        }
        let coordinate = without_suffix(&name.text, RATE_SUFFIX)?;
        let graph = &self.bench.graph;
        let is_it = |x: ExprId| graph.as_symbol(x).is_some_and(|x| graph.symbol_info(x).name == coordinate);
        let (_, velocity) = *self.motion.coordinates.iter().find(|(x, _)| is_it(*x))?;
        let symbol = self.bench.graph.symbol(&name.text, Role::QuasiVelocity);
        self.expansions.insert(symbol, velocity);
        let first = (name.clone(), self.place.description(self.entry.as_deref()));
        self.rates.0.insert(name.text.clone(), Assumed { symbol, first });
        Some(Value::Scalar(symbol))
    }

    /// Completes the forms by rates of coordinates, which come behind the parameters that are declared. Where the forms given are
    /// dependent whatever completes them, so that this is reported of them, no reason is given.
    pub(super) fn complete<'a>(
        &mut self,
        raw: &mut Vec<RawForm<'a>>,
        degrees: usize,
        forms: &[(Form, ExprId)],
        coordinates: &[SymbolEntry<'a>],
        constants: &[ConstantEntry<'_>],
    ) -> Option<ChosenRates> {
        let rows: Vec<Vec<ExprId>> = forms.iter().map(|(form, _)| form.row.clone()).collect();
        let equations: Vec<ExprId> = raw.iter().filter_map(|form| form.position).collect();
        let symbols: Vec<ExprId> = coordinates.iter().map(|coordinate| coordinate.symbol).collect();
        let values = nominal(&self.bench.graph, constants);
        let value = |symbol: SymbolId| values.get(&symbol).copied().unwrap_or(1.0);
        let choice = chosen_rates(&mut self.bench.graph, &rows, &equations, &symbols, &value);
        let name = |place: usize| suffixed(&coordinates[place].name.text, RATE_SUFFIX);
        let places = match &choice {
            Ok(choice) => choice.coordinates.clone(),
            Err(places) => places.clone(),
        };
        for (count, place) in places.iter().enumerate() {
            let form = self.rate(&coordinates[*place], name(*place));
            raw.insert(degrees + count, form);
        }
        let choice = choice.ok()?;
        let names = |places: &[usize]| places.iter().map(|place| name(*place)).collect();
        Some(ChosenRates {
            names: names(&choice.coordinates),
            condition: choice.condition,
            best: (names(&choice.best.0), choice.best.1),
        })
    }

    /// The rate of a coordinate as a form.
    fn rate<'a>(&mut self, coordinate: &SymbolEntry<'a>, name: String) -> RawForm<'a> {
        let written = coordinate.name;
        if let Some(taken) = self.scope.category(&name) {
            let fault = Fault::new(
                written.span(),
                format!("the rate of `{written}` is chosen as a parameter, and `{name}` is {}", taken.noun()),
            );
            // As in the component, if the coordinate belongs to an instance.
            let own = written.text.rsplit('.').next().unwrap_or_default();
            self.faults.report(fault.help(format!(
                "declare `parameters {{ rate_of_{own} = dot({own}); }}`, or give {} another name",
                taken.noun().replacen("an ", "the ", 1).replacen("a ", "the ", 1)
            )));
        }
        let graph = &self.bench.graph;
        let is_it = |x: ExprId| x == coordinate.symbol;
        let moving = self.motion.coordinates.iter().find(|(x, _)| is_it(*x));
        let definition = moving.map_or(graph.zero(), |(_, velocity)| *velocity);
        let symbol = match self.rates.0.remove(&name) {
            Some(assumed) => assumed.symbol,
            None => self.bench.graph.symbol(&name, Role::QuasiVelocity),
        };
        self.expansions.insert(symbol, definition);
        self.scope.declare_chosen(&name, written.span(), Category::Parameter, Value::Scalar(symbol));
        RawForm {
            shape: self.shapes.form(definition),
            entry: FormEntry {
                name,
                written,
                docs: UNDOCUMENTED,
                kind: FormKind::Parameter,
                mentioned_in_energy: false,
            },
            symbol,
            definition,
            position: None,
            sides: Vec::new(),
        }
    }

    /// Reports names of rates that were used and are no parameters.
    pub(super) fn report_assumed(&mut self, chosen: Option<&ChosenRates>) {
        for (text, Assumed { first: (name, place), .. }) in std::mem::take(&mut self.rates.0) {
            let Some(chosen) = chosen else {
                // Unknown, as any other name.
                let _ = self.scope.look_up(self.faults, &name, &place);
                continue;
            };
            let coordinate = without_suffix(&text, RATE_SUFFIX).unwrap_or_else(|| text.clone());
            let names = quoted(chosen.names.iter().map(String::as_str));
            let fault = Fault::new(name.span(), format!("`{name}` is used in {place} and is no parameter"))
                .note(format!("as rates of coordinates the macro chose {names}"));
            self.faults.report(fault.help(format!(
                "write `dot({coordinate})`, or declare `parameters {{ {name} = dot({coordinate}); }}`"
            )));
        }
    }

    /// Names of rates that scenes may use where faults leave the choice open.
    pub(super) fn excuse_rates(&mut self, coordinates: &[SymbolEntry<'_>]) {
        self.rates.0.clear();
        for coordinate in coordinates {
            self.scope.excuse(suffixed(&coordinate.name.text, RATE_SUFFIX), coordinate.name.span());
        }
    }
}

/// The values of constants at which sets of rates are compared: defaults, else one.
pub(crate) fn nominal(graph: &Graph, constants: &[ConstantEntry<'_>]) -> BTreeMap<SymbolId, f64> {
    let mut values = BTreeMap::new();
    for constant in constants {
        let (Some(symbol), Some(default)) = (graph.as_symbol(constant.symbol), constant.default) else {
            continue;
        };
        let value = |symbol: SymbolId| values.get(&symbol).copied().unwrap_or(1.0);
        let value = evaluate_f64(graph, &[default], &value)[0];
        if value.is_finite() {
            values.insert(symbol, value);
        }
    }
    values
}

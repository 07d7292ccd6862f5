//! Scenes: their names and values are checked as the language says.

use std::collections::BTreeSet;

use guen_symbolic::{ExprId, SignBound, Substitution};

use super::evaluate::Evaluator;
use super::expression_place::ExpressionPlace;
use super::scope::Category;
use super::value::Value;
use super::{ConstantEntry, FixedConstant, SceneEntry, SceneModes};
use crate::diagnostics::Fault;
use crate::names::{self, module_name};
use crate::syntax::{Declaration, Fix, Item, Name, Provide, Scene};

/// The quantities that a scene may provide beside outputs.
const QUANTITIES: [&str; 7] =
    ["energy", "reactions", "linearization", "operators", "carried", "taylor", "source"];

/// Whether a name is that of a carried form, and the declaration asks for one.
pub(crate) fn is_carried_form(name: &Name, declaration: &Declaration) -> bool {
    let asks = |provides: &[Provide]| provides.iter().any(|provide| provide.name.text == "carried");
    names::CARRIED_ITEMS.contains(&name.text.as_str())
        && declaration.items.iter().any(|item| match item {
            Item::Provide(section) => asks(&section.entries),
            Item::Scene(scene) => asks(&scene.provides),
            _ => false,
        })
}

impl Evaluator<'_> {
    /// Checks a scene's statements at their words; `None` after a fault.
    pub(super) fn scene<'a>(
        &mut self,
        scene: &'a Scene,
        declaration: &Declaration,
        earlier: &[&Scene],
        constants: &[ConstantEntry<'_>],
        is_in_mode: bool,
    ) -> Option<SceneEntry<'a>> {
        let before = self.faults.count();
        self.scene_name(&scene.name, declaration, earlier);
        let mut fixes = Vec::new();
        let mut held = Vec::new();
        self.once(&scene.tracks, "tracked");
        for name in &scene.tracks {
            self.tracked(name);
        }
        self.once(scene.fixes.iter().map(|fix| &fix.name), "fixed");
        for fix in &scene.fixes {
            match fix.value {
                Some(_) => fixes.extend(self.fixed(fix)),
                None => held.extend(self.held(&fix.name, &scene.tracks)),
            }
        }
        self.once(scene.provides.iter().filter(|p| p.of.is_none()).map(|provide| &provide.name), "provided");
        for provide in &scene.provides {
            self.provided(provide, is_in_mode);
        }
        self.resolve_values(&mut fixes, constants);
        (self.faults.count() == before).then_some(SceneEntry {
            scene,
            fixes,
            held,
            modes: SceneModes::Without,
        })
    }

    /// A scene becomes a struct and a module in the module of the system.
    fn scene_name(&mut self, name: &Name, declaration: &Declaration, earlier: &[&Scene]) {
        if let Some(first) = earlier.iter().find(|other| other.name.text == name.text) {
            let fault = Fault::new(name.span(), format!("`{name}` is declared twice"));
            self.faults.report(fault.note_place("first declared as a scene", first.name.span()));
            return;
        }
        let module = module_name(&name.ident, "scene");
        let taken = if names::is_generated_type_or_constant(&name.text)
            || names::is_generated_item(&module.to_string())
        {
            Some(format!("the module of `{}` has an item of this name", declaration.name))
        } else if name.text == declaration.name.text {
            Some("this is the name of the system".to_owned())
        } else if module == declaration.name.text {
            Some("its module would have the name of the system".to_owned())
        } else if is_carried_form(name, declaration) {
            Some("a carried form has this name".to_owned())
        } else {
            earlier
                .iter()
                .find(|other| module_name(&other.name.ident, "scene") == module)
                .map(|other| format!("`{}` and `{name}` would share the module `{module}`", other.name))
        };
        if let Some(why) = taken {
            let fault = Fault::new(name.span(), format!("a scene cannot be called `{name}` here")).note(why);
            self.faults.report(fault.help("choose another name"));
        }
    }

    /// Names that stand twice in the statements of one kind.
    fn once<'n>(&mut self, names: impl IntoIterator<Item = &'n Name>, what: &str) {
        let mut seen = BTreeSet::new();
        for name in names {
            if !seen.insert(&name.text) {
                self.faults.report(Fault::new(name.span(), format!("`{name}` is {what} twice")));
            }
        }
    }

    fn tracked(&mut self, name: &Name) {
        match self.scope.category(&name.text) {
            Some(Category::Coordinate | Category::Parameter | Category::State) => self.scope.refer(name),
            Some(other) => {
                let noun = other.noun();
                let fault = Fault::new(
                    name.span(),
                    format!("`{name}` is {noun}, and a scene tracks coordinates, parameters and states"),
                );
                self.faults.report(match other {
                    Category::Output => {
                        fault.help(format!("a quantity that is computed is provided: `provide {name};`"))
                    }
                    Category::Let => {
                        fault.help(format!("declare it under `outputs`, and write `provide {name};`"))
                    }
                    _ => fault,
                });
            }
            None => self.unknown(name, "a scene"),
        }
    }

    /// `fix name = value`.
    fn fixed<'a>(&mut self, fix: &'a Fix) -> Option<FixedConstant<'a>> {
        let (name, written) = (&fix.name, fix.value.as_ref()?);
        match self.scope.category(&name.text) {
            Some(Category::Constant) => {
                self.scope.refer(name);
                self.entry = Some(name.text.clone());
                // A number, or made of constants; a fault is reported there.
                let mut value = self.scalar_at(ExpressionPlace::Fixed, written).ok()?;
                let mut symbol = match self.scope.peek(&name.text) {
                    Some(Value::Scalar(symbol)) => *symbol,
                    _ => return None,
                };
                let graph = &mut self.bench.graph;
                if graph.as_symbol(symbol).is_none() {
                    // It is declared in degrees, as is a number that it is fixed to.
                    let own = graph.symbols_in(&[symbol]).into_iter().next()?;
                    symbol = graph.symbol_expr(own);
                    if !graph.symbols_in(&[value]).is_empty() {
                        let degree = graph.degree();
                        value = graph.div(value, degree);
                    }
                }
                return Some(FixedConstant { name, symbol, value });
            }
            Some(Category::Coordinate | Category::Parameter | Category::State) => {
                self.faults.report(
                    Fault::new(written.first_token(), format!("`{name}` is fixed at its initial value"))
                        .help(format!("write `fix {name};`")),
                );
            }
            _ => self.not_fixed(name),
        }
        None
    }

    /// `fix name`.
    fn held<'a>(&mut self, name: &'a Name, tracks: &[Name]) -> Option<&'a Name> {
        match self.scope.category(&name.text) {
            Some(Category::Coordinate | Category::Parameter | Category::State) => {
                if tracks.iter().any(|tracked| tracked.text == name.text) {
                    let fault = Fault::new(name.span(), format!("`{name}` is tracked and fixed"));
                    self.faults
                        .report(fault.note("what is fixed is a constant of the scene, and has no rate"));
                    return None;
                }
                self.scope.refer(name);
                return Some(name);
            }
            Some(Category::Constant) => {
                self.faults.report(
                    Fault::new(name.span(), format!("constant `{name}` is fixed to a value"))
                        .help(format!("write `fix {name} = 1;`")),
                );
            }
            _ => self.not_fixed(name),
        }
        None
    }

    fn not_fixed(&mut self, name: &Name) {
        match self.scope.category(&name.text) {
            Some(other) => {
                let noun = other.noun();
                self.faults.report(Fault::new(
                    name.span(),
                    format!("`{name}` is {noun}, and a scene fixes constants, and coordinates, parameters or states at rest"),
                ));
            }
            None => self.unknown(name, "a scene"),
        }
    }

    /// Values that use fixed constants get the values of these; what cannot be is reported.
    fn resolve_values(&mut self, fixes: &mut [FixedConstant<'_>], constants: &[ConstantEntry<'_>]) {
        let symbols: Vec<ExprId> = fixes.iter().map(|fix| fix.symbol).collect();
        // Each round replaces every fixed constant by its value: a value that needs more rounds uses itself.
        for _ in 0..fixes.len() {
            let values: Vec<ExprId> = fixes.iter().map(|fix| fix.value).collect();
            let mut by_values = Substitution::new(symbols.iter().copied().zip(values));
            for fix in fixes.iter_mut() {
                fix.value = by_values.of(&mut self.bench.graph, fix.value);
            }
        }
        let values: Vec<(ExprId, ExprId)> = fixes.iter().map(|fix| (fix.symbol, fix.value)).collect();
        let mut at_values = Substitution::new(values);
        for fix in fixes {
            let graph = &self.bench.graph;
            let inside: Vec<ExprId> =
                graph.symbols_in(&[fix.value]).into_iter().map(|symbol| graph.symbol_expr(symbol)).collect();
            if inside.iter().any(|symbol| symbols.contains(symbol)) {
                let text = format!("the value of `{}` depends on itself", fix.name);
                self.faults.report(Fault::new(fix.name.span(), text));
                continue;
            }
            let Some(symbol) = graph.as_symbol(fix.symbol) else { continue };
            let limits = constants.iter().find(|constant| constant.symbol == fix.symbol);
            if let Some([lower, upper]) = limits.and_then(|constant| constant.limits) {
                let graph = &mut self.bench.graph;
                let [lower, upper] = [lower, upper].map(|limit| at_values.of(graph, limit));
                let outside = [graph.sub(fix.value, lower), graph.sub(upper, fix.value)];
                if outside.iter().any(|rest| graph.as_number(*rest).is_some_and(|rest| rest.is_negative())) {
                    let text = format!("this value lies outside of the limits of `{}`", fix.name);
                    let fault = Fault::new(fix.name.span(), text);
                    self.faults.report(fault.help("change the value, or the limits under `constants`"));
                    continue;
                }
            }
            let graph = &self.bench.graph;
            let Some(number) = graph.as_number(fix.value) else { continue };
            let broken = match graph.symbol_info(symbol).bound {
                SignBound::Positive => (number.is_negative() || number.is_zero()).then_some("> 0"),
                SignBound::NonNegative => number.is_negative().then_some(">= 0"),
                SignBound::NonZero => number.is_zero().then_some("!= 0"),
                _ => None,
            };
            if let Some(bound) = broken {
                let name = fix.name;
                let fault =
                    Fault::new(name.span(), format!("this value does not keep the bound `{name} {bound}`"));
                self.faults.report(fault.help("change the value, or the bound under `constants`"));
            }
        }
    }

    /// `is_in_mode` says whether contacts are constraints of the scene.
    fn provided(&mut self, provide: &Provide, is_in_mode: bool) {
        let name = &provide.name;
        let is_output = self.scope.category(&name.text) == Some(Category::Output);
        if is_output {
            self.scope.refer(name);
        } else if !QUANTITIES.contains(&name.text.as_str()) {
            let near = names::nearest(&name.text, QUANTITIES);
            let fault = Fault::new(name.span(), format!("a scene cannot provide `{name}`"));
            self.faults.report(match (near, self.scope.category(&name.text)) {
                (_, Some(Category::Coordinate | Category::Parameter | Category::State)) => {
                    fault.help(format!("variables are tracked: `track {name};`"))
                }
                (Some(near), _) => fault.help(format!("did you mean `{near}`?")),
                (None, _) => {
                    fault.help(format!("it provides {} and declared outputs", names::quoted(QUANTITIES)))
                }
            });
        }
        let Some(of) = &provide.of else { return };
        self.once(of, "provided");
        for constraint in of {
            if name.text != "reactions" {
                self.faults.report(Fault::new(constraint.span(), format!("`{name}` takes no names")));
                return;
            }
            let category = self.scope.category(&constraint.text);
            if category == Some(Category::Constraint) || (is_in_mode && category == Some(Category::Contact)) {
                self.scope.refer(constraint);
            } else {
                let fault = Fault::new(constraint.span(), format!("`{constraint}` is not a constraint"));
                let fault = fault.note("reactions are those of constraints");
                self.faults.report(match category {
                    Some(Category::Contact) => fault.help(format!(
                        "declare an output, `force = reaction({constraint});`, and provide that"
                    )),
                    _ => fault,
                });
            }
        }
    }

    fn unknown(&mut self, name: &Name, place: &str) {
        // The scope reports it with the nearest known name.
        let _ = self.scope.look_up(self.faults, name, place);
    }
}

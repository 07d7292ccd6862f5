//! What is emitted beside the errors of a faulty declaration: the public items with their signatures.
//!
//! The rest of the user's crate then reports its own mistakes only, and completion keeps working. Bodies are
//! never reached, since the crate does not compile. What is a vector is guessed from how it is written.

mod carried;
mod control;
mod kinds;
mod scenes;

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::layout::{self, facade};
use crate::model::is_carried_form;
use crate::names::module_name;
use crate::syntax::{Declaration, Definition, Item, Plain};
use kinds::{Kind, Kinds};

/// The items of a declaration by its names alone.
pub fn outline(declaration: &Declaration) -> TokenStream {
    let system = &declaration.name.ident;
    let name = &declaration.name;
    let is_hidden = name.text == layout::REAL;
    if crate::names::is_generated_item(&name.text) || is_hidden || is_carried_form(name, declaration) {
        // Two items of one name would be a second error; generic code would not find a system behind its real.
        return TokenStream::new();
    }
    let names = Names::new(declaration);
    let facade = facade(declaration);
    let module = module_name(system, "system");
    let visibility = declaration.visibility.outside();
    let records = records(&names);
    let constants = constants(system, &names);
    let prepared = prepared(system, &names);
    let operators = operators(&names);
    let scenes = scenes::items(declaration, &names);
    let provides = declaration.items.iter().filter_map(|item| match item {
        Item::Provide(section) => Some(&section.entries),
        _ => None,
    });
    let carried = carried::items(&names, &provides.flatten().collect::<Vec<_>>());
    let levels = levels(&names);
    quote! {
        /// The module of a system whose declaration has faults.
        #[allow(
            non_snake_case, non_camel_case_types, non_upper_case_globals, dead_code, unused_variables,
            unreachable_pub, clippy::all, clippy::pedantic, reason = "stands in for a faulty declaration"
        )]
        #visibility mod #module {
            #[allow(unused_imports, reason = "stands in for a faulty declaration")]
            use #facade::__private as __guen;
            #constants
            #records
            #prepared
            #operators
            #levels
            /// The system and its scenes.
            pub const LEVELS: [__guen::LevelInfo; 0] = [];
            /// The system and its scenes as a table.
            pub const fn levels() -> __guen::Levels { __guen::Levels(&LEVELS) }
            #carried
            #scenes
        }
        #[allow(unused_imports, reason = "stands in for a faulty declaration")]
        #visibility use #module::#system;
    }
}

/// The names of the fields.
#[derive(Clone, Default)]
struct Names {
    constants: Vec<Ident>,
    required: Vec<Ident>,
    /// The constants whose defaults are made of others.
    derived: Vec<Ident>,
    coordinates: Vec<Ident>,
    /// Coordinates, then parameters.
    state: Vec<Ident>,
    parameters: Vec<Ident>,
    constraints: Vec<Ident>,
    inputs: Vec<Ident>,
    outputs: Vec<(Ident, bool)>,
    /// The number of bodies and particles.
    bodies: usize,
}

impl Names {
    fn new(declaration: &Declaration) -> Self {
        let mut names = Names::default();
        let mut kinds = Kinds::default();
        for item in &declaration.items {
            match item {
                Item::Constants(section) => {
                    for constant in &section.entries {
                        push(&mut names.constants, &constant.name.ident);
                        if constant.default.is_none() {
                            push(&mut names.required, &constant.name.ident);
                        }
                        let others = &section.entries;
                        if constant
                            .default
                            .as_ref()
                            .is_some_and(|e| others.iter().any(|c| e.mentions(&c.name.text)))
                        {
                            push(&mut names.derived, &constant.name.ident);
                        }
                    }
                }
                Item::Coordinates(section) => plain(&mut names.coordinates, &section.entries),
                Item::Inputs(section) => plain(&mut names.inputs, &section.entries),
                Item::Let(definition) => {
                    kinds.define(definition);
                }
                Item::Bodies(section) => {
                    section.entries.iter().for_each(|body| kinds.body(&body.name));
                    names.bodies += section.entries.len();
                }
                Item::Particles(section) => names.bodies += section.entries.len(),
                Item::Parameters(section) => {
                    for parameter in &section.entries {
                        let kind = kinds.define(parameter);
                        fields(&mut names.parameters, &parameter.name.ident, kind);
                    }
                }
                Item::Constraints(section) | Item::Holonomic(section) => {
                    for equation in &section.entries {
                        let kind = kinds.of(&equation.left).or(kinds.of(&equation.right));
                        fields(&mut names.constraints, &equation.name.ident, kind);
                    }
                }
                Item::Outputs(section) => {
                    for output in &section.entries {
                        output_field(&mut names.outputs, output, kinds.define(output));
                    }
                }
                _ => {}
            }
        }
        names.state = names.coordinates.clone();
        names.parameters.iter().for_each(|name| push(&mut names.state, name));
        names
    }
}

/// A name once: a second one was reported as a fault already.
fn push(names: &mut Vec<Ident>, name: &Ident) {
    if !names.contains(name) {
        names.push(name.clone());
    }
}

fn plain(names: &mut Vec<Ident>, entries: &[Plain]) {
    entries.iter().for_each(|entry| push(names, &entry.name.ident));
}

/// The field of a scalar, or the three of a vector.
fn fields(names: &mut Vec<Ident>, name: &Ident, kind: Kind) {
    if kind == Kind::Vector {
        for axis in ["x", "y", "z"] {
            push(names, &format_ident!("{name}_{axis}", span = name.span()));
        }
    } else {
        push(names, name);
    }
}

fn output_field(outputs: &mut Vec<(Ident, bool)>, output: &Definition, kind: Kind) {
    if outputs.iter().all(|(known, _)| *known != output.name.ident) {
        outputs.push((output.name.ident.clone(), kind == Kind::Vector));
    }
}

/// The struct of constants.
fn constants(system: &Ident, names: &Names) -> TokenStream {
    let Names { constants, required, derived, .. } = names;
    let types = constants.iter().map(|name| match derived.contains(name) {
        true => quote!(__guen::Derived<R>),
        false => quote!(R),
    });
    let is_unit = constants.is_empty() && system.to_string().starts_with(char::is_uppercase);
    let marker = constants.is_empty().then(|| quote!(real: ::core::marker::PhantomData<R>,));
    let unit = is_unit.then(|| {
        quote! {
            /// The system.
            pub const #system: #system = #system { real: ::core::marker::PhantomData };
        }
    });
    let new = match required.is_empty() {
        true => quote! {
            impl #system<::core::primitive::f64> {
                /// The default constants.
                pub fn new() -> Self { ::core::unreachable!() }
                /// The default constants over another real.
                pub fn with_defaults<R: __guen::Real>() -> #system<R> { ::core::unreachable!() }
            }
            impl ::core::default::Default for #system<::core::primitive::f64> {
                fn default() -> Self { ::core::unreachable!() }
            }
        },
        false => quote! {
            impl<R: __guen::Real> #system<R> {
                /// The constants.
                pub fn new(#(#required: R),*) -> Self { ::core::unreachable!() }
            }
        },
    };
    quote! {
        /// The constants.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
        )]
        pub struct #system<R = f64> {
            #(#[doc = ""] pub #constants: #types,)*
            #marker
        }
        impl<R: __guen::Real> #system<R> {
            /// The prepared system.
            pub fn prepare(self) -> ::core::result::Result<Prepared<R>, __guen::ConstantsError> {
                ::core::unreachable!()
            }
        }
        #unit
        #new
    }
}

fn records(names: &Names) -> TokenStream {
    let mut momenta = names.parameters.clone();
    names.constraints.iter().for_each(|name| push(&mut momenta, name));
    let mut items = vec![
        record("State", &names.state),
        record("Coordinates", &names.coordinates),
        record("Momenta", &momenta),
    ];
    if !names.constraints.is_empty() {
        items.push(record("Residuals", &names.constraints));
        items.push(record("Reactions", &names.constraints));
    }
    if !names.inputs.is_empty() {
        items.push(record("Inputs", &names.inputs));
        items.push(quote! {
            /// The system with held inputs.
            #[::core::prelude::v1::derive(
                ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
            )]
            pub struct Driven<R = f64> {
                /// The system.
                pub system: Prepared<R>,
                /// The inputs.
                pub inputs: Inputs<R>,
            }
        });
    }
    if !names.outputs.is_empty() {
        let fields = names.outputs.iter().map(|(name, is_vector)| {
            let kind = if *is_vector { quote!([R; 3]) } else { quote!(R) };
            quote!(#[doc = ""] pub #name: #kind,)
        });
        items.push(quote! {
            /// The outputs.
            #[::core::prelude::v1::derive(
                ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq,
                ::core::default::Default
            )]
            pub struct Outputs<R = f64> { #(#fields)* }
        });
    }
    let size = names.state.len();
    items.push(quote!(__guen::nalgebra_conversions!(State, #size);));
    quote!(#(#items)*)
}

fn record(name: &str, fields: &[Ident]) -> TokenStream {
    let name = format_ident!("{name}");
    let count = fields.len();
    let none =
        fields.is_empty().then(|| quote!(#[doc(hidden)] pub __guen_real: ::core::marker::PhantomData<R>,));
    quote! {
        /// Stands in for a faulty declaration.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq,
            ::core::default::Default
        )]
        pub struct #name<R = f64> {
            #(#[doc = ""] pub #fields: R,)*
            #none
        }
        impl #name<f64> {
            /// The names of the fields.
            pub const NAMES: [&'static str; #count] = [""; #count];
        }
        impl<R> ::core::convert::From<[R; #count]> for #name<R> {
            fn from(_: [R; #count]) -> Self { ::core::unreachable!() }
        }
        impl<R> ::core::convert::From<#name<R>> for [R; #count] {
            fn from(_: #name<R>) -> Self { ::core::unreachable!() }
        }
    }
}

/// The prepared system with its methods.
fn prepared(system: &Ident, names: &Names) -> TokenStream {
    let (size, n, bound) = (names.state.len(), names.coordinates.len(), names.constraints.len());
    let inputs = names.inputs.len();
    let driven = (inputs > 0).then(|| quote!(, inputs: &Inputs<R>));
    let outputs = (!names.outputs.is_empty()).then(|| {
        quote! {
            /// The outputs.
            pub fn outputs(&self, t: R, state: &State<R> #driven) -> Outputs<R> { ::core::unreachable!() }
        }
    });
    let constraints = (bound > 0).then(|| {
        quote! {
            /// The residuals.
            pub fn residuals(&self, t: R, state: &State<R>) -> Residuals<R> { ::core::unreachable!() }
            /// The reactions.
            pub fn reactions(&self, t: R, state: &State<R> #driven) -> Reactions<R> { ::core::unreachable!() }
            /// The coordinates on the holonomic constraints.
            pub fn consistent(
                &self, t: R, guess: &Coordinates<R>, given: &[&'static str],
            ) -> ::core::result::Result<Coordinates<R>, __guen::PositionsError> {
                ::core::unreachable!()
            }
        }
    });
    let hold = (inputs > 0).then(|| {
        quote! {
            /// The system with these inputs held.
            pub fn driven(&self, inputs: Inputs<R>) -> Driven<R> { ::core::unreachable!() }
        }
    });
    let owner = if inputs > 0 { format_ident!("Driven") } else { format_ident!("Prepared") };
    let owners = ["Prepared", "Driven"].map(|owner| format_ident!("{owner}"));
    let owners = &owners[..1 + usize::from(inputs > 0)];
    let count = names.bodies;
    let bodies = (count > 0).then(|| {
        quote! {
            #(impl<R: __guen::Real> __guen::Bodies<R, #size, #count> for #owners<R> {
                fn bodies(&self, _: R, _: &[R; #size]) -> [__guen::Body<R>; #count] { ::core::unreachable!() }
            })*
        }
    });
    let positions = (bound > 0).then(|| {
        quote! {
            #(impl<R: __guen::Real> __guen::Positions<R, #n, #bound> for #owners<R> {
                fn gaps(&self, _: R, _: &[R; #n]) -> [R; #bound] { ::core::unreachable!() }
                fn linearized(&self, _: R, _: &[R; #n]) -> ([R; #bound], [[R; #n]; #bound]) { ::core::unreachable!() }
            })*
        }
    });
    let control = control::items(&control::Sizes { n, size, inputs }, bound > 0, !names.outputs.is_empty());
    let kinds = [
        "Holonomic",
        "LieGroup",
        "Nonholonomic",
        "IncompleteLieGroup",
        "Scleronomic",
        "Rheonomic",
        "Catastatic",
        "Conservative",
    ];
    let kinds = kinds.map(|kind| format_ident!("{kind}"));
    quote! {
        impl<R: __guen::Real> #system<R> {
            /// The system with its bodies checked.
            pub fn prepare_physical(self) -> ::core::result::Result<Prepared<R>, __guen::ConstantsError> {
                ::core::unreachable!()
            }
        }
        /// The prepared system.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
        )]
        pub struct Prepared<R = f64>(::core::marker::PhantomData<R>);
        impl<R: __guen::Real> Prepared<R> {
            /// The constants.
            pub fn constants(&self) -> #system<R> { ::core::unreachable!() }
            /// The system over a larger real.
            pub fn lift<S: __guen::Lift<R>>(&self) -> Prepared<S> { ::core::unreachable!() }
            /// The rates.
            pub fn rhs(&self, t: R, state: &State<R> #driven) -> State<R> { ::core::unreachable!() }
            /// The velocities.
            pub fn velocities(&self, t: R, state: &State<R>) -> Coordinates<R> { ::core::unreachable!() }
            /// The energy integral.
            pub fn energy(&self, t: R, state: &State<R>) -> R { ::core::unreachable!() }
            /// The kinetic energy.
            pub fn kinetic_energy(&self, t: R, state: &State<R>) -> R { ::core::unreachable!() }
            /// The force function.
            pub fn force_function(&self, t: R, state: &State<R>) -> R { ::core::unreachable!() }
            /// The momenta.
            pub fn momenta(&self, t: R, state: &State<R>) -> Momenta<R> { ::core::unreachable!() }
            /// The power.
            pub fn power(&self, t: R, state: &State<R> #driven) -> R { ::core::unreachable!() }
            /// The domain of the chart.
            pub fn domain(&self, t: R, state: &State<R>) -> [R; 0] { ::core::unreachable!() }
            /// The distances to the edge.
            pub fn distances(&self, t: R, state: &State<R>) -> [R; 0] { ::core::unreachable!() }
            /// The condition of the mass matrix.
            pub fn condition(&self, t: R, state: &State<R>) -> R { ::core::unreachable!() }
            /// The linearisation.
            pub fn linearize(
                &self, t: R, state: &State<R> #driven
            ) -> __guen::Linearization<R, #size, #inputs> {
                ::core::unreachable!()
            }
            #outputs
            #constraints
            #hold
        }
        #control
        #positions
        #bodies
        impl<R: __guen::Real> State<R> {
            /// The state at given velocities.
            pub fn from_velocities(
                system: &Prepared<R>, t: R, coordinates: &Coordinates<R>, velocities: &Coordinates<R>,
            ) -> (Self, [R; #bound]) {
                ::core::unreachable!()
            }
            /// The coordinates.
            pub fn coordinates(&self) -> Coordinates<R> { ::core::unreachable!() }
        }
        impl<R: __guen::Real> __guen::System<R, #size> for #owner<R> {
            fn rhs(&self, _: R, _: &[R; #size]) -> [R; #size] { ::core::unreachable!() }
        }
        impl<R: __guen::Real> __guen::Simulate<R, #size> for #owner<R> {
            type State = State<R>;
        }
        impl<R: __guen::Real> __guen::Monitored<R, #size> for #owner<R> {
            fn energy(&self, _: R, _: &[R; #size]) -> R { ::core::unreachable!() }
            fn residual(&self, _: R, _: &[R; #size]) -> R { ::core::unreachable!() }
        }
        impl<R: __guen::Real> __guen::Differentiable<R, #size> for #owner<R> {
            fn jacobian(&self, _: R, _: &[R; #size]) -> [[R; #size]; #size] { ::core::unreachable!() }
            fn along(&self, _: R, _: &[R; #size], _: R, _: &[R; #size]) -> [R; #size] { ::core::unreachable!() }
        }
        impl __guen::Recast<#size> for #owner<f64> {
            type In<R: __guen::Real> = #owner<R>;
            fn recast<R: __guen::Real>(&self) -> ::core::result::Result<#owner<R>, __guen::ConstantsError> {
                ::core::unreachable!()
            }
        }
        #(impl<R> __guen::#kinds for #owner<R> {})*
        /// The class.
        pub const CLASS: __guen::Class = __guen::Class::Undecided;
        /// The growth vector.
        pub const GROWTH: [usize; 0] = [];
        /// The number of integrable combinations.
        pub const INTEGRABLE: usize = #n - #n;
        /// Whether the growth vector is complete.
        pub const GROWTH_IS_COMPLETE: bool = false;
        /// Scleronomic.
        pub const SCLERONOMIC: bool = true;
        /// Catastatic.
        pub const CATASTATIC: bool = true;
        /// Conservative.
        pub const CONSERVATIVE: bool = true;
        const NO_COST: __guen::Cost = __guen::Cost {
            additions: 0, negations: 0, multiplications: 0, divisions: 0, roots: 0, calls: 0,
        };
        /// The cost.
        pub const COST: __guen::Cost = NO_COST;
        /// The cost of `prepare`.
        pub const PREPARE_COST: __guen::Cost = NO_COST;
        /// The domain of the chart.
        pub const DOMAIN: [&str; 0] = [];
        /// The report.
        pub const REPORT: __guen::Report = __guen::Report { name: "", summary: "", sections: &[] };
        /// The report.
        pub const LATEX: __guen::Report = REPORT;
        impl #system<f64> {
            /// The class.
            pub const CLASS: __guen::Class = CLASS;
            /// The growth vector.
            pub const GROWTH: &'static [usize] = &GROWTH;
            /// The cost.
            pub const COST: __guen::Cost = NO_COST;
            /// The cost of `prepare`.
            pub const PREPARE_COST: __guen::Cost = NO_COST;
        }
    }
}

fn operators(names: &Names) -> TokenStream {
    let n = names.coordinates.len();
    let derives = quote! {
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::default::Default,
            ::core::cmp::PartialEq, ::core::cmp::Eq
        )]
    };
    let operators = (0..=n).map(|j| {
        let name = format_ident!("X{j}");
        quote! {
            /// An operator.
            #derives
            pub struct #name;
            impl<B: __guen::Real> __guen::Operator<B, #n> for #name {
                type Prepared = Prepared<B>;
                const TIME: bool = false;
                fn coefficients<R: __guen::Real + __guen::Lift<B>>(
                    _: &Prepared<B>, _: R, _: &[R; #n],
                ) -> [R; #n] {
                    ::core::unreachable!()
                }
            }
        }
    });
    quote! {
        #(#operators)*
        /// A bracket.
        #derives
        pub struct Bracket<const I: usize, const J: usize>;
        impl<B: __guen::Real, const I: usize, const J: usize> __guen::BracketCoefficients<B, #n> for Bracket<{ I }, { J }> {
            type Prepared = Prepared<B>;
            const I: usize = I;
            const J: usize = J;
            const COEFFICIENTS: [__guen::Coefficient; #n] = [__guen::Coefficient::Variable; #n];
            fn coefficients<R: __guen::Real + __guen::Lift<B>>(
                _: &Prepared<B>, _: R, _: &[R; #n],
            ) -> [R; #n] {
                ::core::unreachable!()
            }
        }
    }
}

/// The common trait of the system and its scenes.
fn levels(names: &Names) -> TokenStream {
    let size = names.state.len();
    let owner = if names.inputs.is_empty() { format_ident!("Prepared") } else { format_ident!("Driven") };
    quote! {
        /// What the level costs.
        pub const INFO: __guen::LevelInfo =
            __guen::LevelInfo { name: "", variables: &[], cost: NO_COST, prepare_cost: NO_COST };
        impl<R: __guen::Real> __guen::Level<R, #size, #size> for #owner<R> {
            const PLACES: [usize; #size] = [0; #size];
            const QUADRATURES: &'static [&'static [usize]] = &[];
            const INFO: __guen::LevelInfo = INFO;
        }
    }
}

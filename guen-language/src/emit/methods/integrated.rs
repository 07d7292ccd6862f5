//! Methods for steppers besides the rates: quantities for guards, and derivatives for implicit methods.

use guen_symbolic::OperationCount;
use proc_macro2::TokenStream;
use quote::quote;

use crate::derive::{Subject, function};
use crate::emit::layouts::layout::Layout;
use crate::emit::thresholds::{
    CHECK_OVERHEAD, COMPARISON_COST, COUNTED_ROUNDING, SECOND_SYSTEM_COST, SECOND_SYSTEM_SINGULARITIES,
    SINGULARITY_CHECK_OVERHEAD, STAGE_COST,
};
use crate::model::Model;

/// The methods `restore`, `switches` and `guarded` of the trait `System`, as far as the level has what they look at. `prepared` is the
/// prepared system.
pub(super) fn integrated(subject: &Subject<'_, '_>, layout: &Layout, prepared: &TokenStream) -> TokenStream {
    let (level, size) = (subject.level, layout.size);
    let switches = (!level.switches.is_empty()).then(|| {
        let count = level.switches.len();
        let inputs = match layout.inputs {
            0 => quote!([]),
            _ => quote!(::core::convert::From::from(self.inputs)),
        };
        quote!(__guen::switches!(#prepared; #size #count #inputs);)
    });
    let restored = restored(subject, layout);
    quote! {
        #restored
        #switches
        __guen::guarded!(#size);
    }
}

/// The trait `Guarded`. `prepared` is the prepared system.
pub(super) fn guarded(subject: &Subject<'_, '_>, layout: &Layout, prepared: &TokenStream) -> TokenStream {
    let level = subject.level;
    let (owner, size, n, l) = (owner(layout), layout.size, layout.n, layout.l);
    // Only an energy that is kept is worth its price.
    let kept = (layout.is_whole && level.derivation.conservative).then(|| quote!(kept));
    let held = (!level.selection.holonomic.is_empty()).then(|| quote!(positions));
    let edges = (level.singularities > 0).then(|| {
        let count = level.singularities;
        quote!([#count])
    });
    let masses = level.program(function::MASS).map(|_| quote!(; #l));
    let (all, hundredths) = CheckOperations::of(subject, layout).in_rates(subject, layout);
    quote! {
        impl<R: __guen::Real> __guen::Guarded<R, #size> for #owner<R> {
            __guen::guard_answers!(#prepared; #n #size, #all #hundredths, [#kept] [#held] #edges #masses);
        }
    }
}

/// The method `restore` of a system with contacts or resets, which ends runs that would ignore them at their first step.
pub(in crate::emit) fn restored(subject: &Subject<'_, '_>, layout: &Layout) -> Option<TokenStream> {
    let size = layout.size;
    has_modes(subject).then(|| quote!(__guen::restored_by_modes!(#size);))
}

/// A word for macros that implement what runs by the rates alone: a motion of the system goes through modes.
pub(in crate::emit) fn through_modes(subject: &Subject<'_, '_>) -> Option<TokenStream> {
    has_modes(subject).then(|| quote!(; through modes))
}

/// Whether the rates alone move unlike what is declared: something can touch, grip or lock, or has new values at a reset.
pub(in crate::emit) fn has_modes(subject: &Subject<'_, '_>) -> bool {
    let contacts = subject.model.contacts.as_ref().is_some_and(|contacts| !contacts.entries.is_empty());
    contacts || subject.level.contacts.as_ref().is_some_and(|facts| !facts.resets.is_empty())
}

/// The operations of checks: an estimate from the counts of their programs.
#[derive(Clone, Copy)]
pub(in crate::emit) struct CheckOperations {
    /// The cost of `conserved`, `singularities` and `condition` together.
    pub(super) all: u64,
    /// The cost of `singularities` alone.
    pub(super) singularities: u64,
}

impl CheckOperations {
    /// Returns the costs of a level by itself.
    pub(in crate::emit) fn of(subject: &Subject<'_, '_>, layout: &Layout) -> Self {
        let level = subject.level;
        let cost = |names: &[&str]| -> u64 {
            let programs = names.iter().filter_map(|name| level.program(name));
            programs.map(|program| program.cost.weighted()).sum()
        };
        let rounded = |name: &str| {
            level.program(name).map_or(0, |program| {
                let OperationCount { sines, calls, .. } = program.cost;
                let functions = OperationCount { sines, calls, ..Default::default() }.weighted();
                let [of_operations, of_functions] = COUNTED_ROUNDING;
                of_operations * (program.cost.weighted() - functions) + of_functions * functions
            })
        };
        let energies = if layout.is_whole && level.derivation.conservative {
            cost(&[function::ENERGY, function::KINETIC_ENERGY, function::FORCE_FUNCTION])
        } else {
            0
        };
        let singularities = rounded(function::DOMAIN) + COMPARISON_COST * level.singularities as u64;
        // Factors of the matrix and the diagonal of its inverse, roots and divisions for scaling: in loops over short rows,
        // which take more than their operations.
        let l = layout.l as u64;
        let condition = level.program(function::MASS).map_or(0, |_| l * l * (l + 20));
        let carried = COMPARISON_COST * level.selection.carried.len() as u64;
        let others =
            rounded(function::POSITIONS) + cost(&[function::MASS, function::CARRY, function::INVARIANTS]);
        Self { all: energies + singularities + condition + carried + others, singularities }
    }

    /// Returns the costs of a carried form and of the level that it is a form of, which is given a state of its own.
    pub(in crate::emit) fn and(self, below: Self) -> Self {
        let singularities = self.singularities + below.singularities;
        let another = if singularities > 0 { SECOND_SYSTEM_SINGULARITIES } else { 0 };
        Self { all: self.all + below.all + SECOND_SYSTEM_COST, singularities: singularities + another }
    }

    /// The numbers that `check_costs` returns: operations of checks in right-hand sides with what a stepper does for each, and those of
    /// singularities in hundredths.
    pub(in crate::emit) fn in_rates(self, subject: &Subject<'_, '_>, layout: &Layout) -> (u32, u32) {
        let rhs = subject.level.program(function::RHS).map_or(0, |program| program.cost.weighted());
        let one = (rhs + STAGE_COST * layout.size as u64).max(1);
        let short = |cost: u64| u32::try_from(cost).unwrap_or(u32::MAX);
        let all = short((self.all + CHECK_OVERHEAD).div_ceil(one));
        // In hundredths, which are enough.
        let hundredths = match self.singularities {
            0 => 0,
            singularities => short(((singularities + SINGULARITY_CHECK_OVERHEAD) * 100).div_ceil(one)),
        };
        (all, hundredths)
    }
}

/// A function of the program with the roundings counted: prepared values were rounded once.
pub(in crate::emit) fn rounded(
    function: &TokenStream,
    prepared: &TokenStream,
    t: &TokenStream,
    state: &TokenStream,
) -> TokenStream {
    quote! {
        program::#function(
            &__guen::rounded(&#prepared.constants), &__guen::PreparedValues::rounded_once(&#prepared.hoisted), #t, #state,
        )
    }
}

/// The trait `Differentiable`, by dual numbers over the real; the Jacobian as `linearize` has it where that is code of its own.
pub(in crate::emit) fn differentiable(layout: &Layout, has_code: bool) -> TokenStream {
    let Layout { size, inputs, .. } = layout;
    let inputs = (*inputs > 0).then(|| quote!(, #inputs));
    let code = has_code.then(|| quote!(; code));
    quote!(__guen::differentiable!(#size #inputs #code);)
}

/// The trait `Simulate` of what steppers integrate: its states have named fields.
pub(in crate::emit) fn simulate(
    subject: &Subject<'_, '_>,
    layout: &Layout,
    domain: bool,
    positions: bool,
) -> TokenStream {
    let (owner, size) = (owner(layout), layout.size);
    // With contacts it stays with what `restore` says.
    let positions = (positions && !has_modes(subject)).then(|| quote!(__guen::onto_constraints!(#size);));
    let names = layout.state.names().iter().cloned();
    let units = units(subject.model, names);
    // A carried form lies in a module of its own, and its domain beside the system's.
    let names = if domain { quote!(SWITCHES) } else { quote!(super::SWITCHES) };
    let switches = (!subject.level.switches.is_empty())
        .then(|| quote!(const SWITCHES: &'static [&'static str] = &#names;));
    let domain = domain.then(|| quote!(DOMAIN));
    let scene = subject.scene().map(|(scene, _)| scene);
    let digest = proc_macro2::Literal::u64_unsuffixed(subject.whole.declaration.digest(scene));
    quote!(__guen::simulated! { #owner #size #digest [#domain] [#(#units)*] #switches #positions })
}

/// The units of entries by their names; nothing where no unit is declared.
pub(in crate::emit) fn units(model: &Model<'_>, names: impl Iterator<Item = String>) -> Vec<String> {
    if model.units.is_empty() {
        return Vec::new();
    }
    let unit = |name: String| model.units.get(name.trim_start_matches("r#")).cloned().unwrap_or_default();
    names.map(unit).collect()
}

/// The name of what steppers integrate.
pub(super) fn owner(layout: &Layout) -> TokenStream {
    if layout.inputs == 0 { quote!(Prepared) } else { quote!(Driven) }
}

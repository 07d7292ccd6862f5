//! Methods for controllers, with the names of the declaration.

use guen_symbolic::{Operation, Role};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use crate::derive::{Subject, function, has_covector, known_combinations};
use crate::emit::layouts::fields::{Fields, Tree};
use crate::emit::layouts::layout::{Layout, given, inputs};
use crate::syntax::{Name, Step};

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    if !layout.is_whole {
        return TokenStream::new();
    }
    let is_written_out = subject.level.derivation.is_written_out();
    let mass_form = is_written_out.then(|| mass_form(layout));
    let dynamics = if is_written_out { dynamics(subject, layout) } else { None };
    let inverse = (layout.inputs > 0 && is_written_out).then(|| inverse_dynamics(subject, layout));
    let reduce = reduce(subject, layout);
    let reactions = reactions(subject, layout);
    let (size, count, given) = (layout.size, layout.inputs, given(layout));
    let on = (!subject.level.selection.holonomic.is_empty()).then(|| quote!(; on constraints));
    let reduced = size - known_combinations(&subject.level.derivation).len();
    quote! {
        /// The size of the reduced basis: the positions that the integrable constraints leave independent, and the
        /// parameters.
        pub const REDUCED: usize = #reduced;

        impl<R: __guen::Real> Prepared<R> {
            #mass_form
        }
        #dynamics
        impl<R: __guen::Ordered + __guen::Lift<R>> Prepared<R> {
            #inverse
            __guen::steady_motions!(#size, #count #given #on);
            #reduce
        }
        #reactions
    }
}

/// The equations apart.
fn mass_form(layout: &Layout) -> TokenStream {
    let (parameter, given) = (inputs(layout).0, given(layout));
    let (l, count) = (layout.l, layout.inputs);
    if l == 0 {
        return quote! {
            /// The equations of motion apart: there are none.
            pub fn mass_form(&self, _t: R, _state: &State<R> #parameter) -> __guen::control::MassForm<R, 0, #count> {
                __guen::control::MassForm { mass: [], bias: [], input: [] }
            }
        };
    }
    quote!(__guen::mass_form!(#l, #count #given);)
}

/// The parts of the equations, and the Jacobians of outputs.
fn dynamics(subject: &Subject<'_, '_>, layout: &Layout) -> Option<TokenStream> {
    let (n, size, count) = (layout.n, layout.size, layout.inputs);
    let l = layout.l;
    let has = |name: &str| subject.level.program(name).is_some().then(|| format_ident!("{name}"));
    let (mass, coasting) = (has(function::MASS), has(function::COASTING));
    let has_outputs = !subject.level.selection.outputs.is_empty();
    let jacobians = has_outputs.then(|| quote!(__guen::jacobians!(#n, #l, #size, #count);));
    (l > 0).then(|| {
        quote! {
            impl<R: __guen::Real + __guen::Lift<R>> Prepared<R> {
                __guen::dynamics!(#n, #l, #size, #count, [#mass], [#coasting]);
                #jacobians
            }
        }
    })
}

/// Whether the forces are affine in the inputs: then neither the bias nor the matrix of the inputs reads them.
fn is_affine(subject: &Subject<'_, '_>) -> bool {
    let graph = &subject.model.bench.graph;
    let reads = |operation: &Operation| match operation {
        Operation::Symbol(symbol) => graph.symbol_info(*symbol).role == Role::Input,
        _ => false,
    };
    let program = subject.level.program(function::MASS_FORM);
    program
        .is_none_or(|program| !program.instructions.iter().any(|instruction| reads(&instruction.operation)))
}

fn inverse_dynamics(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let (n, l, size, count) = (layout.n, layout.l, layout.size, layout.inputs);
    let accelerations: Vec<usize> = (n..n + l).collect();
    let wanted = quote!(&[#(rate[#accelerations]),*]);
    let convert = quote!(::core::convert::From::from);
    let (how, refused, solve) = if is_affine(subject) {
        let solve = quote! {
            let form = self.mass_form(t, state, &#convert([R::zero(); #count]));
            let found = __guen::control::affine_inverse_dynamics(&form, #wanted)?;
        };
        let how = "The forces are affine in the inputs. Where the inputs are more than the forces they make, those of least length.";
        (how, "The accelerations are outside of what the inputs reach, or something is not finite.", solve)
    } else {
        let solve = quote! {
            let form = |inputs: &_| self.mass_form(t, state, &#convert(*inputs));
            let found = __guen::control::inverse_dynamics(form, #wanted)?;
        };
        let how =
            "The forces are not affine in the inputs: by Newton's method from zero and 16 other starts.";
        (
            how,
            "No such inputs were found, which does not say that there are none, or something is not finite.",
            solve,
        )
    };
    quote! {
        /// The inputs that produce given accelerations: of `rate` the fields of the parameters count, as
        /// [`rhs`](Self::rhs) returns them.
        #[doc = #how]
        ///
        /// # Errors
        ///
        #[doc = #refused]
        pub fn inverse_dynamics(
            &self, t: R, state: &State<R>, rate: &State<R>,
        ) -> ::core::result::Result<Inputs<R>, __guen::control::InverseDynamicsError> {
            let rate: [R; #size] = #convert(*rate);
            #solve
            ::core::result::Result::Ok(#convert(found))
        }

        /// The inputs that produce given accelerations, as [`inverse_dynamics`](Self::inverse_dynamics), by Newton's method from these
        /// inputs.
        ///
        /// # Errors
        ///
        /// No such inputs were found from there, or something is not finite.
        pub fn inverse_dynamics_from(
            &self, t: R, state: &State<R>, rate: &State<R>, start: &Inputs<R>,
        ) -> ::core::result::Result<Inputs<R>, __guen::control::InverseDynamicsError> {
            let rate: [R; #size] = #convert(*rate);
            let start: [R; #count] = #convert(*start);
            let form = |inputs: &_| self.mass_form(t, state, &#convert(*inputs));
            let found = __guen::control::inverse_dynamics_from(form, #wanted, &start)?;
            ::core::result::Result::Ok(#convert(found))
        }
    }
}

fn reduce(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Layout { n, size, inputs: count, .. } = layout;
    let given = given(layout);
    let combinations = known_combinations(&subject.level.derivation).len();
    let reduced = size - combinations;
    let leaf = (combinations > 0).then(|| quote!(leaf));
    let quaternions = subject.model.quaternions.iter().map(|[w, x, y, z]| quote!([#w, #x, #y, #z]));
    quote!(__guen::reduce!(#n, #size, #count, #reduced, #combinations, [#leaf], [#(#quaternions),*] #given);)
}

/// The covector of the reactions, and the forces of vector constraints.
fn reactions(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Layout { n, l, size, .. } = layout;
    let given = given(layout);
    let covector = has_covector(&subject.level.derivation).then(|| {
        quote! {
            impl<R: __guen::Real> Prepared<R> {
                __guen::reaction_covector!(#n, #l, #size #given);
            }
        }
    });
    let vectors = vectors(subject, layout);
    let of_instances = of_instances(&vectors);
    let vectors: Vec<_> = vectors.into_iter().filter(|(name, _)| inner_module(name).is_none()).collect();
    let structure = Fields::new(vectors.iter().map(|(name, _)| name));
    let values: Vec<TokenStream> = vectors.into_iter().map(|(_, value)| quote!([#(#value),*])).collect();
    let methods = structure.trees().map(|(name, tree)| {
        let docs = match tree {
            Tree::Leaf(_) => format!(
                "The reaction of the vector constraint `{name}`, as a force or torque in the world's axes."
            ),
            _ => format!(
                "The reactions of the vector constraints `{name}`, as forces or torques in the world's axes."
            ),
        };
        let (kind, value) = (tree.of_type(&quote!([R; 3])), tree.literal(&|place| values[place].clone()));
        quote! {
            #[doc = #docs]
            pub fn #name(&self) -> #kind {
                #value
            }
        }
    });
    let methods: Vec<TokenStream> = methods.collect();
    let vectors = (!methods.is_empty()).then(|| {
        quote! {
            impl<R: __guen::Real> Reactions<R> {
                #(#methods)*
            }
        }
    });
    quote!(#covector #vectors #of_instances)
}

/// The module of the instance that a name belongs to.
fn inner_module(name: &Name) -> Option<Vec<Ident>> {
    let path = name.path()?;
    let fields = path.steps.iter().filter_map(|step| match step {
        Step::Field(field) => Some(field.clone()),
        Step::Index { .. } => None,
    });
    let mut module: Vec<Ident> = std::iter::once(path.module().clone()).chain(fields).collect();
    module.pop();
    (!module.is_empty()).then_some(module)
}

/// The reactions of vector constraints of instances, as methods of the structs of these.
fn of_instances(vectors: &[(Name, [TokenStream; 3])]) -> TokenStream {
    let mut seen = std::collections::BTreeSet::new();
    let methods = vectors.iter().filter_map(|(name, value)| {
        let module = inner_module(name)?;
        let Some(Step::Field(own)) = name.path()?.steps.last() else { return None };
        let known: Vec<String> = module.iter().chain([own]).map(ToString::to_string).collect();
        if !seen.insert(known) {
            // Another entry of an array of instances.
            return None;
        }
        let parts = ["_x", "_y", "_z"].into_iter().zip(value).map(|(axis, value)| {
            let part = quote::format_ident!("{own}{axis}", span = own.span());
            if value.to_string().starts_with("self") { quote!(self.#part) } else { value.clone() }
        });
        let docs = format!(
            "The reaction of the vector constraint `{own}`, as a force or torque in the world's axes."
        );
        Some(quote! {
            impl<R: __guen::Real> #(#module::)* Reactions<R> {
                #[doc = #docs]
                pub fn #own(&self) -> [R; 3] {
                    [#(#parts),*]
                }
            }
        })
    });
    methods.collect()
}

/// Constraints that were written as vectors, with the components of their reactions; of a component that
/// says `0 = 0` there is none. Left out if a reaction is not known.
fn vectors(subject: &Subject<'_, '_>, layout: &Layout) -> Vec<(Name, [TokenStream; 3])> {
    let known = &subject.level.selection.reactions;
    let names: Vec<Name> = known.iter().map(|form| subject.model.forms[*form].own_name()).collect();
    let reactions = Fields::new(&names);
    let constraints = &subject.model.forms[layout.l..];
    let mut found: Vec<(Name, [TokenStream; 3])> = Vec::new();
    for form in constraints {
        let name = form.written;
        if form.name == name.text || found.iter().any(|(known, _)| known.text == name.text) {
            continue;
        }
        let parts = ["_x", "_y", "_z"].map(|axis| {
            let own = crate::names::suffixed(&name.text, axis);
            let is_there = constraints.iter().any(|c| c.name == own && c.written.text == name.text);
            let place = names.iter().position(|name| name.text == own);
            match place {
                Some(place) if is_there => {
                    let way = reactions.access(place);
                    Some(quote!(self.#way))
                }
                _ if is_there => None,
                _ => Some(quote!(R::zero())),
            }
        });
        if let [Some(x), Some(y), Some(z)] = parts {
            found.push((name.clone(), [x, y, z]));
        }
    }
    found
}

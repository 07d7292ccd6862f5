//! What controllers ask of a prepared system, with the names of its declaration.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::motion::inputs;
use super::{Layout, Subject};
use crate::control::{has_covector, known_combinations};

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    if !layout.is_whole {
        return TokenStream::new();
    }
    let mass_form = mass_form(layout);
    let inverse = (layout.inputs > 0).then(|| inverse_dynamics(layout));
    let steady = steady(layout);
    let reduce = reduce(subject, layout);
    let reactions = reactions(subject, layout);
    let size = layout.size;
    let reduced = size - known_combinations(&subject.level.derivation).len();
    quote! {
        /// The size of the reduced basis: the positions that the integrable constraints leave independent, and the
        /// parameters.
        pub const REDUCED: usize = #reduced;

        impl<R: __guen::Real> Prepared<R> {
            #mass_form
        }
        impl<R: __guen::Ordered + __guen::Lift<R>> Prepared<R> {
            #inverse
            #steady
            #reduce
        }
        #reactions
    }
}

/// The equations apart.
fn mass_form(layout: &Layout) -> TokenStream {
    let (parameter, argument) = inputs(layout);
    let (l, count) = (layout.size - layout.n, layout.inputs);
    let triangle = l * (l + 1) / 2;
    let input_at = triangle + l;
    let entries = if l == 0 {
        quote!(let entries: [R; 0] = [];)
    } else {
        quote! {
            let entries = program::mass_form(
                &self.constants, &self.hoisted, t, &::core::convert::From::from(*state), #argument,
            );
        }
    };
    quote! {
        /// The equations of motion apart, `M eta' + bias = G u`: the mass matrix, what the forces are without inputs
        /// with its sign turned, and the matrix of the inputs. Where forces are not affine in the inputs, `G` holds
        /// their derivatives, and the equation is exact at these inputs.
        pub fn mass_form(&self, t: R, state: &State<R> #parameter) -> __guen::control::MassForm<R, #l, #count> {
            #entries
            let entry = |s: usize, k: usize| if s < k { entries[k * (k + 1) / 2 + s] } else { entries[s * (s + 1) / 2 + k] };
            __guen::control::MassForm {
                mass: ::core::array::from_fn(|s| ::core::array::from_fn(|k| entry(s, k))),
                bias: ::core::array::from_fn(|s| entries[#triangle + s]),
                input: ::core::array::from_fn(|s| ::core::array::from_fn(|j| entries[#input_at + s * #count + j])),
            }
        }
    }
}

fn inverse_dynamics(layout: &Layout) -> TokenStream {
    let (n, size) = (layout.n, layout.size);
    let accelerations: Vec<usize> = (n..size).collect();
    quote! {
        /// The inputs that produce given accelerations: of `rate` the fields of the parameters count, as
        /// [`rhs`](Self::rhs) returns them. Where the inputs are more than the forces they make, those of least length.
        ///
        /// # Errors
        ///
        /// The accelerations are outside of what the inputs reach, or something is not finite.
        pub fn inverse_dynamics(
            &self, t: R, state: &State<R>, rate: &State<R>,
        ) -> ::core::result::Result<Inputs<R>, __guen::control::InverseDynamicsError> {
            let rate: [R; #size] = ::core::convert::From::from(*rate);
            let form = |inputs: &_| self.mass_form(t, state, &::core::convert::From::from(*inputs));
            let found = __guen::control::inverse_dynamics(form, &[#(rate[#accelerations]),*])?;
            ::core::result::Result::Ok(::core::convert::From::from(found))
        }
    }
}

fn steady(layout: &Layout) -> TokenStream {
    let (size, count) = (layout.size, layout.inputs);
    let docs = "The search stays near the guess. What is fixed, and what drifts, stays as it is there; names are those of the \
                state and of the inputs. Newton's method with the exact linearisation.";
    let errors = quote! {
        ///
        /// # Errors
        ///
        /// An unknown name; a family of solutions, of which as many further quantities have to be fixed as it has
        /// dimensions; no solution near the guess.
    };
    let (parameter, pass, held, names, result, found) = if count == 0 {
        (
            quote!(),
            quote!(),
            quote!([]),
            quote!([]),
            quote!(State<R>),
            quote!(let (state, []) = found; ::core::result::Result::Ok(::core::convert::From::from(state))),
        )
    } else {
        (
            quote!(, inputs: &Inputs<R>),
            quote!(, inputs),
            quote!(::core::convert::From::from(*inputs)),
            quote!(Inputs::<f64>::NAMES),
            quote!((State<R>, Inputs<R>)),
            quote! {
                let (state, inputs) = found;
                ::core::result::Result::Ok((::core::convert::From::from(state), ::core::convert::From::from(inputs)))
            },
        )
    };
    let result = quote!(::core::result::Result<#result, __guen::control::SteadyError>);
    quote! {
        /// A steady motion near a guess: the rates of everything vanish but of what is `drifting`, such as the place of a
        /// car that drives in a circle.
        ///
        #[doc = #docs]
        #errors
        pub fn steady_motion(
            &self, t: R, state: &State<R> #parameter, drifting: &[&'static str], fixed: &[&'static str],
        ) -> #result {
            let states = State::<f64>::NAMES;
            let names: [&'static str; #count] = #names;
            let (drifting, _) = __guen::control::named(drifting, &states, &[])?;
            let (fixed_states, fixed_inputs) = __guen::control::named(fixed, &states, &names)?;
            let request = __guen::control::SteadyMotion::<#size, #count> { drifting, fixed_states, fixed_inputs };
            let state: [R; #size] = ::core::convert::From::from(*state);
            let found = __guen::control::steady(self, t, &state, &#held, &request)?;
            #found
        }

        /// An equilibrium near a guess: all rates vanish.
        ///
        #[doc = #docs]
        #errors
        pub fn equilibrium(&self, t: R, state: &State<R> #parameter, fixed: &[&'static str]) -> #result {
            self.steady_motion(t, state #pass, &[], fixed)
        }
    }
}

fn reduce(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let (parameter, argument) = inputs(layout);
    let (n, size, count) = (layout.n, layout.size, layout.inputs);
    let pass = if count == 0 { quote!() } else { quote!(, inputs) };
    let combinations = known_combinations(&subject.level.derivation).len();
    let reduced = size - combinations;
    let quaternions = subject.model.quaternions.iter().map(|[w, x, y, z]| quote!([#w, #x, #y, #z]));
    let positions: Vec<usize> = (0..n).collect();
    let entries = if combinations == 0 {
        quote!(let entries: [R; 0] = [];)
    } else {
        quote!(let entries = program::leaf(&self.constants, &self.hoisted, t, &coordinates);)
    };
    quote! {
        /// The linearisation on the leaf of all integrable combinations of constraints: independent positions, then the
        /// parameters, [`REDUCED`] in all. Coordinates named in `independent` stay independent, the others are chosen by
        /// pivots; of a quaternion its three rotation components are taken. Exact at equilibria and away from them.
        ///
        /// # Errors
        ///
        /// An unknown name; more names than there are independent positions, or an edge of the chart.
        pub fn reduce(
            &self, t: R, state: &State<R> #parameter, independent: &[&'static str],
        ) -> ::core::result::Result<__guen::control::Reduced<R, #size, #count, #reduced>, __guen::control::ReduceError> {
            let s: [R; #size] = ::core::convert::From::from(*state);
            let coordinates = [#(s[#positions]),*];
            #entries
            let leaf = __guen::control::Leaf::<R, #n, #combinations> {
                coordinates,
                velocities: program::velocities(&self.constants, &self.hoisted, t, &s),
                rows: ::core::array::from_fn(|row| ::core::array::from_fn(|i| entries[row * #n + i])),
                quaternions: &[#(#quaternions),*],
                independent: __guen::control::independent(independent, &State::<f64>::NAMES)?,
            };
            let rates = program::rhs(&self.constants, &self.hoisted, t, &s, #argument);
            leaf.reduce(&self.linearize(t, state #pass), &rates)
        }
    }
}

/// The covector of the reactions, and the forces of vector constraints.
fn reactions(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let (parameter, argument) = inputs(layout);
    let (n, size) = (layout.n, layout.size);
    let accelerations: Vec<usize> = (n..size).collect();
    let covector = has_covector(&subject.level.derivation).then(|| {
        quote! {
            impl<R: __guen::Real> Prepared<R> {
                /// The reactions of all constraints as one covector on the velocities, `R_i = sum_v lambda_v a_vi`: the
                /// generalised force on every coordinate.
                pub fn reaction_covector(&self, t: R, state: &State<R> #parameter) -> Coordinates<R> {
                    let s: [R; #size] = ::core::convert::From::from(*state);
                    let rates = program::rhs(&self.constants, &self.hoisted, t, &s, #argument);
                    ::core::convert::From::from(program::reaction_covector(
                        &self.constants, &self.hoisted, t, &s, #argument, &[#(rates[#accelerations]),*],
                    ))
                }
            }
        }
    });
    let methods = vectors(subject, layout).into_iter().map(|(name, fields)| {
        let docs = format!(
            "The reaction of the vector constraint `{name}`, as a force or torque in the world's axes."
        );
        let parts = fields.iter().map(|field| match field {
            Some(field) => quote!(self.#field),
            None => quote!(R::zero()),
        });
        quote! {
            #[doc = #docs]
            pub fn #name(&self) -> [R; 3] {
                [#(#parts),*]
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
    quote!(#covector #vectors)
}

/// Constraints that were written as vectors, with the fields of their components among the reactions; of a component that
/// says `0 = 0` there is none. Left out if a reaction is not known.
fn vectors(subject: &Subject<'_, '_>, layout: &Layout) -> Vec<(Ident, [Option<Ident>; 3])> {
    let constraints = &subject.model.forms[layout.l..];
    let mut found: Vec<(Ident, [Option<Ident>; 3])> = Vec::new();
    for form in constraints {
        let name = &form.written.ident;
        if form.name == form.written.text || found.iter().any(|(known, _)| known == name) {
            continue;
        }
        let of = |axis: &str| format!("{}_{axis}", form.written.text);
        let parts = ["x", "y", "z"].map(|axis| {
            let place = constraints.iter().position(|c| c.name == of(axis) && c.written.ident == *name);
            place.map(|v| (subject.level.derivation.reactions[v].is_some(), format_ident!("{}", of(axis))))
        });
        if parts.iter().flatten().all(|(known, _)| *known) {
            found.push((name.clone(), parts.map(|part| part.map(|(_, ident)| ident))));
        }
    }
    found
}

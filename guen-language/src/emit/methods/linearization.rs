//! The exact linearisations of rates and outputs: by code of their own, or by dual numbers where that would be long.

use std::fmt::Write;
use std::ops::Range;

use guen_symbolic::Pattern;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::integrated;
use crate::derive::{Subject, function};
use crate::emit::layouts::layout::{Layout, inputs};
use crate::emit::layouts::signatures::{self, Signature};
use crate::emit::layouts::text::{cost, tokens};
use crate::emit::thresholds::{CALLED_DIRECTIONS, SPARSE_RESULTS};

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let level = subject.level;
    if !level.selection.linearization {
        return TokenStream::new();
    }
    let jacobians = &level.jacobians;
    let rates = Target {
        signature: signatures::LINEARIZE,
        docs: "The exact linearisation of [`rhs`](Self::rhs), `d(state)' = A d(state) + B d(inputs)`: `a[i][j]` and \
               `b[i][j]` are the derivatives of the rate `i` by the state `j` and by the input `j`.",
        code: function::LINEARIZATION,
        of: function::RHS,
        rows: layout.size,
        pattern: jacobians.rates.as_ref(),
        fields: ["a", "b"],
        record: "Linearization",
    };
    let outputs = level.program(function::OUTPUTS).map_or(0, |program| program.outputs.len());
    let outputs = (outputs > 0).then_some(Target {
        signature: signatures::linearize_outputs(outputs),
        docs: "The exact linearisation of [`outputs`](Self::outputs), `d(outputs) = C d(state) + D d(inputs)`: a row for \
               each scalar output, three for a vector, in the order of the declaration.",
        code: function::OUTPUT_LINEARIZATION,
        of: function::OUTPUTS,
        rows: outputs,
        pattern: jacobians.outputs.as_ref(),
        fields: ["c", "d"],
        record: "OutputLinearization",
    });
    let methods = [Some(rates), outputs].into_iter().flatten().map(|target| target.method(layout));
    let (size, count) = (layout.size, layout.inputs);
    let given = if count == 0 { quote!() } else { quote!(, inputs) };
    let modes = integrated::through_modes(subject);
    let cost = match level.program(function::LINEARIZATION) {
        Some(program) => {
            let cost = cost(&program.cost);
            quote!(::core::option::Option::Some(#cost))
        }
        None => quote!(::core::option::Option::None),
    };
    quote! {
        /// The operations of one linearisation of the rates; `None` where it is computed by dual numbers.
        pub const LINEARIZATION_COST: ::core::option::Option<__guen::Cost> = #cost;

        impl<R: __guen::Real> Prepared<R> {
            #(#methods)*
        }
        __guen::linearizable!(#size, #count #given #modes);
    }
}

/// A function that is linearised.
struct Target<'a> {
    signature: Signature,
    docs: &'static str,
    /// The function of the derivatives, and the function itself.
    code: &'static str,
    of: &'static str,
    rows: usize,
    pattern: Option<&'a Pattern>,
    /// The matrices by state and by inputs.
    fields: [&'static str; 2],
    record: &'static str,
}

impl Target<'_> {
    fn method(&self, layout: &Layout) -> TokenStream {
        let (_, argument) = inputs(layout);
        let (size, count, rows) = (layout.size, layout.inputs, self.rows);
        let [code, of, record] = [self.code, self.of, self.record].map(ident);
        let [by_state, by_input] = self.fields.map(ident);
        let docs = match self.pattern {
            Some(pattern) => format!(
                "{} {} of {} entries do not vanish identically; they are computed by straight-line code.",
                self.docs,
                pattern.len(),
                rows * (size + count),
            ),
            None => format!("{} Computed by dual numbers.", self.docs),
        };
        let head = self.signature.head(layout, &quote!());
        let (bounds, body) = match self.pattern {
            Some(pattern) => {
                let cells = cells(pattern, rows, size, count);
                let body = quote! {
                    let e = program::#code(&self.constants, &self.hoisted, t, &state.__guen_array(), #argument);
                    let _ = &e;
                    #cells
                };
                (quote!(), body)
            }
            None => by_duals(layout, &of),
        };
        quote! {
            #[doc = #docs]
            #head #bounds {
                #body
                __guen::#record { #by_state: by_state, #by_input: by_input }
            }
        }
    }
}

fn ident(name: &str) -> Ident {
    format_ident!("{name}")
}

/// The matrices from the entries that do not vanish.
fn cells(pattern: &Pattern, rows: usize, size: usize, count: usize) -> TokenStream {
    let mut places = vec![vec![None; size + count]; rows];
    for (k, (row, column)) in pattern.iter().enumerate() {
        places[*row][*column] = Some(k);
    }
    // As text, which is quicker than tokens: a literal of arrays, which the compiler checks quicker than assignments.
    // Of a large sparse matrix the entries alone.
    let matrix = |name: &str, columns: Range<usize>| {
        if rows * columns.len() > SPARSE_RESULTS && 4 * pattern.len() < rows * columns.len() {
            let mut text = format!("let mut {name} = [[z; {}]; {rows}];", columns.len());
            for (k, (row, column)) in pattern.iter().enumerate() {
                if columns.contains(column) {
                    let _ = write!(text, "{name}[{row}][{}] = e[{k}];", column - columns.start);
                }
            }
            return text;
        }
        let mut text = format!("let {name} = [");
        for row in &places {
            text.push('[');
            for place in &row[columns.clone()] {
                let _ = match place {
                    Some(k) => write!(text, "e[{k}],"),
                    None => write!(text, "z,"),
                };
            }
            text.push_str("],");
        }
        text.push_str("];");
        text
    };
    let (state, input) = (matrix("by_state", 0..size), matrix("by_input", size..size + count));
    tokens(&format!("let z = R::zero(); let _ = z; {state} {input}"))
}

/// The matrices by one evaluation in duals, whose directions are the entries of the state and then the inputs: rustc compiles one
/// more instance of the function, and the values beside the derivatives are computed once.
fn by_duals(layout: &Layout, of: &Ident) -> (TokenStream, TokenStream) {
    let (size, count) = (layout.size, layout.inputs);
    // The function is long: its operations are to be called.
    let directions = (size + count).max(CALLED_DIRECTIONS);
    let dual = quote!(__guen::Dual<R, #directions>);
    let held = match count {
        0 => quote!(let inputs: [R; 0] = [];),
        _ => quote!(let inputs: [R; #count] = ::core::convert::From::from(*inputs);),
    };
    let body = quote! {
        let state: [R; #size] = ::core::convert::From::from(*state);
        #held
        let lifted: Prepared<#dual> = self.lift();
        let values = program::#of(
            &lifted.constants, &lifted.hoisted, __guen::Dual::constant(t),
            &::core::array::from_fn(|j| __guen::Dual::variable(state[j], j)),
            &::core::array::from_fn(|j| __guen::Dual::variable(inputs[j], #size + j)),
        );
        let by_state = values.map(|value| ::core::array::from_fn(|j| value.tangent[j]));
        let by_input = values.map(|value| ::core::array::from_fn(|j| value.tangent[#size + j]));
    };
    (quote!(where #dual: __guen::Lift<R>), body)
}

//! Facts of a system as constants, marker traits, and the report with the page that shows it.

/// Classification, costs and domain: the struct of constants, the class, the growth vector with its length, the number of
/// integrable combinations with whether the brackets were followed to the end, a note where they were not, three properties, the
/// counts of both costs, the domain, what degenerates where each of its functions vanishes, their number, and the traits that the prepared systems have.
#[doc(hidden)]
#[macro_export]
macro_rules! facts {
    (
        $System:ident $Class:ident [$($growth:literal)*] $steps:literal $integrable:literal $complete:literal [$($unfinished:literal)?]
        $scleronomic:literal $catastatic:literal $conservative:literal [$($cost:literal)*] [$($prepare:literal)*]
        [$($domain:literal)*] [$($reason:literal)*] $count:literal $([$($Marker:ident)*] $Owner:ident)*
    ) => {
        /// The class of the forms as declared.
        pub const CLASS: $crate::Class = $crate::Class::$Class;
        /// The growth vector: ranks less one of the distributions that iterated brackets of `X_0 .. X_l` span.
        $(#[doc = $unfinished])?
        pub const GROWTH: [usize; $steps] = [$($growth),*];
        /// The number of independent integrable combinations of the constraints.
        $(#[doc = $unfinished])?
        pub const INTEGRABLE: usize = $integrable;
        /// Whether the brackets were followed to the end; if not, `GROWTH` is only its beginning and `INTEGRABLE` counts
        /// nothing.
        pub const GROWTH_IS_COMPLETE: bool = $complete;
        /// Whether time occurs in neither the constraints nor the energies.
        pub const SCLERONOMIC: bool = $scleronomic;
        /// Whether the constraints have no terms without velocity.
        pub const CATASTATIC: bool = $catastatic;
        /// Whether the energy integral is constant along every motion.
        pub const CONSERVATIVE: bool = $conservative;
        /// The operations of one right-hand side.
        pub const COST: $crate::Cost = $crate::Cost::of([$($cost),*]);
        /// The operations that `prepare` does once.
        pub const PREPARE_COST: $crate::Cost = $crate::Cost::of([$($prepare),*]);
        /// The functions that must not vanish, in the names of the declaration: the domain of the chart.
        pub const DOMAIN: [&str; $count] = [$($domain),*];
        /// Reasons for the functions of [`DOMAIN`]: what degenerates where each of them vanishes, and at which states that is, as far as
        /// it is known.
        pub const DOMAIN_REASONS: [&str; $count] = [$($reason),*];

        impl $System<f64> {
            /// The class of the forms as declared.
            pub const CLASS: $crate::Class = CLASS;
            /// The growth vector.
            pub const GROWTH: &'static [usize] = &GROWTH;
            /// The operations of one right-hand side.
            pub const COST: $crate::Cost = COST;
            /// The operations that `prepare` does once.
            pub const PREPARE_COST: $crate::Cost = PREPARE_COST;
        }

        $($(impl<R> $crate::$Marker for $Owner<R> {})*)*
    };
}

/// A struct with its documentation, and `REPORT` and `LATEX`: the report once, from which rustdoc's page is made, too. The user's
/// own documentation, name, summary, sections, the places of those with formulas, and the struct.
#[doc(hidden)]
#[macro_export]
macro_rules! reported {
    (
        page [$($docs:tt)*] $name:literal $summary:tt
        { $($title:tt [$($line:tt)*] [$($formula:tt)*])* } [$($place:literal)*] $($item:tt)*
    ) => {
        $($docs)*
        #[cfg_attr(not(doc), doc = $crate::text_of_report!($summary $($title [$($line)*])*))]
        #[cfg_attr(doc, doc = __guen::page!($summary $($title [$($line)*] [$($formula)*])*))]
        $($item)*
        $crate::reported! { @ $name $summary { $($title [$($line)*] [$($formula)*])* } [$($place)*] }
    };
    (
        text [$($docs:tt)*] $name:literal $summary:tt
        { $($title:tt [$($line:tt)*] [$($formula:tt)*])* } [$($place:literal)*] $($item:tt)*
    ) => {
        $($docs)*
        #[doc = $crate::text_of_report!($summary $($title [$($line)*])*)]
        $($item)*
        $crate::reported! { @ $name $summary { $($title [$($line)*] [$($formula)*])* } [$($place)*] }
    };
    (
        @ $name:literal $summary:tt { $($title:tt [$($line:tt)*] [$($formula:tt)*])* } [$($place:literal)*]
    ) => {
        /// The derivation as text: forms, operators, brackets, classification, equations of motion.
        pub const REPORT: $crate::Report = $crate::Report {
            name: $name,
            summary: $summary,
            sections: &[$(
                $crate::ReportSection { title: $title, lines: &[$($line),*], formulas: &[$($formula),*] }
            ),*],
        };
        /// The formulas of [`REPORT`] as LaTeX.
        pub const LATEX: $crate::Report = $crate::Report {
            name: $name,
            summary: $summary,
            sections: &REPORT.of_formulas([$($place),*]),
        };
    };
}

/// The report as Markdown for editors, which show text as it is: the summary, and the title and lines of each section.
#[doc(hidden)]
#[macro_export]
macro_rules! text_of_report {
    ($summary:tt $($title:tt [$($line:tt)*])*) => {
        ::core::concat!($summary, "\n" $(, "\n# ", $title, "\n\n```text\n" $(, $line, "\n")*, "```\n")*)
    };
}

/// The right-hand side as a text of C: the word that its functions begin with, the programs, whether there are steppers, and whether DOP853 is one.
#[doc(hidden)]
#[macro_export]
macro_rules! source {
    ($name:literal, $program:literal, $steps:literal, $adaptive:literal, $series:literal) => {
        /// The right-hand side as a text of C, which `Display` writes: a header without includes beyond `math.h`.
        pub const SOURCE: $crate::Source = $crate::Source {
            name: $name,
            program: $program,
            steps: $steps,
            adaptive: $adaptive,
            series: $series,
        };
    };
}

/// The trait `Sourced` of what the text of C has the rates of, with the numbers of states, constants, prepared values, and inputs where there are some.
#[doc(hidden)]
#[macro_export]
macro_rules! sourced {
    ($([$($F:ident $N:literal)*])? $size:literal $constants:literal $hoisted:literal) => {
        impl $(<$($F: $crate::Smooth<$N>),*>)? $crate::Sourced<$size> for Prepared<f64 $($(, $F)*)?> {
            const SOURCE: $crate::Source = SOURCE;
            const NUMBERS: ::core::primitive::usize = $constants + $hoisted;

            fn numbers(&self) -> impl ::core::iter::Iterator<Item = ::core::primitive::f64> {
                ::core::iter::Iterator::copied(::core::iter::Iterator::chain(
                    self.constants.iter(),
                    self.hoisted.iter(),
                ))
            }
        }
    };
    ($([$($F:ident $N:literal)*])? $size:literal $constants:literal $hoisted:literal $inputs:literal) => {
        impl $(<$($F: $crate::Smooth<$N>),*>)? $crate::Sourced<$size> for Driven<f64 $($(, $F)*)?> {
            const SOURCE: $crate::Source = SOURCE;
            const NUMBERS: ::core::primitive::usize = $constants + $hoisted + $inputs;

            fn numbers(&self) -> impl ::core::iter::Iterator<Item = ::core::primitive::f64> {
                let inputs: [::core::primitive::f64; $inputs] = ::core::convert::From::from(self.inputs);
                let prepared = ::core::iter::Iterator::copied(::core::iter::Iterator::chain(
                    self.system.constants.iter(),
                    self.system.hoisted.iter(),
                ));
                ::core::iter::Iterator::chain(prepared, inputs)
            }
        }
    };
}

/// A function that is never called, in which names refer to parameters at their declarations: for editors.
#[doc(hidden)]
#[macro_export]
macro_rules! uses {
    ($($declared:ident)*; $($used:ident)*) => {
        #[allow(dead_code, reason = "for editors: it is never called")]
        fn __guen_uses_lead_to_declarations<$(const $declared: ::core::primitive::bool),*>() {
            let _ = [$($used),*];
        }
    };
}

/// The trait `Simulate` of what steppers integrate: its states have named fields. With the number of states, the digest of the declaration, the names of the
/// functions that must not vanish where there are some, the units of the states where there are some, and what leads back onto constraints on positions.
#[doc(hidden)]
#[macro_export]
macro_rules! simulated {
    ($([$($F:ident $N:literal)*])? $Owner:ident $size:literal $digest:literal [$($domain:ident)?] [$($unit:literal)*] $($positions:tt)*) => {
        impl<R: $crate::Real $($(, $F: $crate::Smooth<$N>)*)?> $crate::Simulate<R, $size> for $Owner<R $($(, $F)*)?> {
            type State = State<R>;
            const STATES: &'static [&'static str] = &State::<f64>::NAMES;
            const UNITS: &'static [&'static str] = &[$($unit),*];
            const DECLARATION: ::core::primitive::u64 = $digest;
            $(const DOMAIN: &'static [&'static str] = &$domain;)?
            $($positions)*
        }
    };
}

/// The trait `Monitored`: the owner and the path to its prepared system, the number of states, and that of coordinates where there are
/// holonomic constraints.
#[doc(hidden)]
#[macro_export]
macro_rules! monitored {
    ($([$($F:ident $N:literal)*])? $Owner:ident, |$prepared:ident| $path:expr, $size:literal $(, $n:literal)?) => {
        impl<R: $crate::Real $($(, $F: $crate::Smooth<$N>)*)?> $crate::Monitored<R, $size> for $Owner<R $($(, $F)*)?> {
            fn energy(&self, t: R, state: &[R; $size]) -> R {
                let $prepared = self;
                let [value] = program::energy(&$path.constants, &$path.hoisted, t, state);
                value
            }

            $(fn residual(&self, t: R, state: &[R; $size]) -> R {
                let $prepared = self;
                let x: [R; $n] = $crate::checks::first(state);
                $crate::checks::largest(&program::positions(&$path.constants, &$path.hoisted, t, &x))
            })?
        }
    };
}

/// The cost of a level of detail: its name.
#[doc(hidden)]
#[macro_export]
macro_rules! level_info {
    ($name:literal) => {
        /// The cost of this level of detail.
        pub const INFO: $crate::LevelInfo = $crate::LevelInfo {
            name: $name,
            variables: &State::<f64>::NAMES,
            cost: COST,
            prepare_cost: PREPARE_COST,
        };
    };
}

/// The table of all levels, by the modules of the scenes.
#[doc(hidden)]
#[macro_export]
macro_rules! levels {
    ($count:literal $($module:ident)*) => {
        /// The system and its scenes, in the order of the declaration: what each costs.
        pub const LEVELS: [$crate::LevelInfo; $count] = [INFO $(, $module::INFO)*];

        /// The system and its scenes side by side, as a table to print.
        pub const fn levels() -> $crate::Levels {
            $crate::Levels(&LEVELS)
        }
    };
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_report_is_text_for_editors() {
        let text =
            text_of_report!("One coordinate." "Coordinates" ["x"] "Forms (1.1), (1.6)" ["u = dot(x)" "v"]);
        assert_eq!(
            text,
            "One coordinate.\n\n# Coordinates\n\n```text\nx\n```\n\n# Forms (1.1), (1.6)\n\n```text\nu = dot(x)\nv\n```\n"
        );
    }
}

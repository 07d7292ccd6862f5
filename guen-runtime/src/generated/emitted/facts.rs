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
/// own documentation, the text for editors, name, summary, sections, the places of those with formulas, and the struct.
#[doc(hidden)]
#[macro_export]
macro_rules! reported {
    (
        page [$($docs:tt)*] $text:literal $name:literal $summary:tt
        { $($title:tt [$($line:tt)*] [$($formula:tt)*])* } [$($place:literal)*] $($item:tt)*
    ) => {
        $($docs)*
        #[cfg_attr(not(doc), doc = $text)]
        #[cfg_attr(doc, doc = __guen::page!($summary $($title [$($line)*] [$($formula)*])*))]
        $($item)*
        $crate::reported! { @ $name $summary { $($title [$($line)*] [$($formula)*])* } [$($place)*] }
    };
    (
        text [$($docs:tt)*] $text:literal $name:literal $summary:tt
        { $($sections:tt)* } [$($place:literal)*] $($item:tt)*
    ) => {
        $($docs)*
        #[doc = $text]
        $($item)*
        $crate::reported! { @ $name $summary { $($sections)* } [$($place)*] }
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
            sections: &[$(REPORT.sections[$place].of_formulas()),*],
        };
    };
}

//! The right-hand side of a system as a text of C, and kernels of it for graphics processors.

mod kernel;
mod sourced;

use core::fmt;

pub use kernel::{Kernel, KernelMethod};
pub use sourced::Sourced;

use crate::steppers::explicit::tableau::Tableau;
use crate::steppers::taylor;

/// The text that the programs of all systems share.
const ELEMENTARY: &str = include_str!("elementary.c");
/// The steppers of a system, whose name stands in the place of `NAME`.
const STEPPERS: &str = include_str!("steppers.c");
/// DOP853, which follows.
const ADAPTIVE: &str = include_str!("adaptive.c");

/// Functions of series, and Taylor's method, where there is one.
const SERIES: &str = include_str!("series.c");
const TAYLOR: &str = include_str!("taylor.c");

/// The program of a system as C99, which `Display` writes: a header without includes beyond `math.h`.
///
/// Systems and scenes with `provide source;` have it as `SOURCE`. With `name` for the module's name, the text has
///
/// | in C | meaning |
/// | --- | --- |
/// | `name_CONSTANTS`, `name_PREPARED`, `name_STATES`, `name_INPUTS` | lengths of the arrays; their order is in a comment at the top |
/// | `name_c_m`, `name_s_theta`, `name_u_torque` | the place of each constant, variable and input |
/// | `name_prepare(c, k)` | computes what depends on constants alone; returns 0, the number of the first faulty constant, or -1 |
/// | `name_rhs(c, k, t, s, u, r)` | the rates `r` of the state `s` |
/// | `name_domain(c, k, t, s, d)` | the functions `d` that must not vanish, `name_DOMAIN` of them |
/// | `name_rk4_step`, `name_rk8_step` | one step of [`Rk4`](crate::steppers::Rk4) or [`Rk8`](crate::steppers::Rk8) |
/// | `name_rk4`, `name_rk8` | steps of one size up to a time |
/// | `name_dop853` | a run of [`Dop853`](crate::steppers::Dop853) with samples |
/// | `name_series(c, k, t, s, u, scale, order, x)` | the coefficients `x[m]` of the motion, times `scale^m`; with `provide taylor;` |
/// | `name_taylor` | a run of [`Taylor`](crate::steppers::Taylor) with samples; with `provide taylor;` |
///
/// Sums, products, quotients, square roots, sines and cosines have the bits that they have in Rust, and so have the steps of programs
/// made of them; other functions are those of the platform's `math.h`. Compile with `-std=c99` or
/// `-ffp-contract=off`: fused operations have other bits. Nothing is allocated, and nothing is stored between calls.
///
/// `name_prepare` checks that constants are finite and keep the bounds `> 0`, `>= 0`, `!= 0` and limits that are numbers; the other checks
/// are those of Rust's `prepare`. There are no steppers where constraints of positions have to be restored after steps, and no DOP853
/// where functions of the motion are piecewise.
///
/// ```
/// use guen_runtime::Source;
/// let source = Source { name: "fall", program: "/* rates */\n", steps: false, adaptive: false, series: false };
/// assert!(source.to_string().starts_with("/* fall: "));
/// assert!(source.to_string().ends_with("/* rates */\n\n#endif\n"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// The name that functions begin with: that of the system's module.
    pub name: &'static str,
    /// The sizes, `prepare` and the right-hand side.
    pub program: &'static str,
    /// Whether the text has steppers.
    pub steps: bool,
    /// Whether DOP853 is one of them: at [switches](crate::System::switches) Rust begins its steps anew.
    pub adaptive: bool,
    /// Whether the program has the series of the motion, and so Taylor's method is one of the steppers.
    pub series: bool,
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Source { name, program, .. } = self;
        writeln!(
            f,
            "/* {name}: equations of motion, written by guen. Compile with -std=c99 or -ffp-contract=off. */"
        )?;
        writeln!(f, "#ifndef GUEN_SYSTEM_{name}\n#define GUEN_SYSTEM_{name}\n")?;
        let series = if self.series { SERIES } else { "" };
        writeln!(f, "{ELEMENTARY}\n{series}{program}")?;
        if self.steps {
            let tableau = Tableau::new();
            self.fill(STEPPERS, &tableau, None, f)?;
            if self.adaptive {
                self.fill(ADAPTIVE, &tableau, None, f)?;
                if self.series {
                    self.fill(TAYLOR, &tableau, None, f)?;
                }
            }
        }
        f.write_str("#endif\n")
    }
}

impl Source {
    /// The kernel that computes motions on a graphics processor, one for each thread; none if the text has no such stepper.
    ///
    /// ```
    /// use guen_runtime::{KernelMethod, Source};
    /// let source = Source { name: "fall", program: "/* rates */\n", steps: true, adaptive: false, series: false };
    /// let kernel = source.kernel(KernelMethod::Rk4).unwrap();
    /// assert_eq!(kernel.entry().to_string(), "fall_motions");
    /// assert!(kernel.to_string().contains("GUEN_KERNEL void fall_motions("));
    /// assert!(source.kernel(KernelMethod::Dop853).is_none());
    /// ```
    pub fn kernel(self, method: KernelMethod) -> Option<Kernel> {
        let has = if method == KernelMethod::Dop853 { self.steps && self.adaptive } else { self.steps };
        has.then_some(Kernel { source: self, method })
    }

    /// Writes a text with what stands for its places; those of a kernel are of a method.
    fn fill(
        &self,
        text: &'static str,
        tableau: &Tableau,
        method: Option<KernelMethod>,
        f: &mut fmt::Formatter<'_>,
    ) -> fmt::Result {
        let weights = || tableau.rows().into_iter().flatten();
        let mut rest = text;
        // Words of capitals are places; everything between is the same for all systems.
        while let Some((before, word, after)) = next_word(rest) {
            f.write_str(before)?;
            match word {
                "NAME" => f.write_str(self.name)?,
                "STEPPER" => f.write_str(method.map_or("", KernelMethod::stepper))?,
                "EVALUATIONS" => write!(f, "{}", method.map_or(0, KernelMethod::evaluations))?,
                "RK8_NODES" => numbers(f, tableau.nodes().iter())?,
                "RK8_WEIGHTS" => numbers(f, weights())?,
                "RK8_COUNT" => write!(f, "{}", weights().count())?,
                "ERROR5_WEIGHTS" => numbers(f, tableau.error_weights()[0].iter())?,
                "ERROR3_WEIGHTS" => numbers(f, tableau.error_weights()[1].iter())?,
                "DENSE_NODES" => numbers(f, tableau.dense_nodes().iter())?,
                "DENSE_WEIGHTS" => numbers(f, tableau.dense_rows().into_iter().flatten())?,
                "DENSE_TERMS" => numbers(f, tableau.dense_terms().iter().flatten())?,
                "ORDER_TOLERANCES" => numbers(f, taylor::order_tolerances().iter())?,
                _ => numbers(f, [taylor::inside_logarithm()].iter())?,
            }
            rest = after;
        }
        f.write_str(rest)
    }
}

/// The words that stand for something else.
const PLACES: [&str; 13] = [
    "NAME",
    "STEPPER",
    "EVALUATIONS",
    "RK8_NODES",
    "RK8_WEIGHTS",
    "RK8_COUNT",
    "ERROR5_WEIGHTS",
    "ERROR3_WEIGHTS",
    "DENSE_NODES",
    "DENSE_WEIGHTS",
    "DENSE_TERMS",
    "ORDER_TOLERANCES",
    "INSIDE_LOGARITHM",
];

/// The text before the first place, the place, and the text behind it.
fn next_word(text: &'static str) -> Option<(&'static str, &'static str, &'static str)> {
    let found = PLACES.into_iter().filter_map(|word| Some((text.find(word)?, word)));
    let (start, word) = found.min_by_key(|(start, _)| *start)?;
    Some((text.get(..start)?, word, text.get(start + word.len()..)?))
}

/// Doubles with as many digits as tell them from their neighbours.
fn numbers<'a>(f: &mut fmt::Formatter<'_>, numbers: impl Iterator<Item = &'a f64>) -> fmt::Result {
    for (i, number) in numbers.enumerate() {
        let before = if i == 0 { "" } else { ", " };
        write!(f, "{before}{number:e}")?;
    }
    Ok(())
}

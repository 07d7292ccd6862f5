//! The right-hand side of a system as a text of C.

use core::fmt;

use crate::steppers::explicit::tableau::Tableau;

/// The text that the programs of all systems share.
const ELEMENTARY: &str = include_str!("elementary.c");
/// The steppers of a system, whose name stands in the place of `NAME`.
const STEPPERS: &str = include_str!("steppers.c");
/// DOP853, which follows.
const ADAPTIVE: &str = include_str!("adaptive.c");

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
/// | `name_rk4_step`, `name_rk8_step` | one step of [`Rk4`](crate::steppers::Rk4) or [`Rk8`](crate::steppers::Rk8) |
/// | `name_rk4`, `name_rk8` | steps of one size up to a time |
/// | `name_dop853` | a run of [`Dop853`](crate::steppers::Dop853) with samples |
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
/// let source = Source { name: "fall", program: "/* rates */\n", steps: false, adaptive: false };
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
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Source { name, program, .. } = self;
        writeln!(
            f,
            "/* {name}: equations of motion, written by guen. Compile with -std=c99 or -ffp-contract=off. */"
        )?;
        writeln!(f, "#ifndef GUEN_SYSTEM_{name}\n#define GUEN_SYSTEM_{name}\n")?;
        writeln!(f, "{ELEMENTARY}\n{program}")?;
        if self.steps {
            let tableau = Tableau::new();
            self.steppers(STEPPERS, &tableau, f)?;
            if self.adaptive {
                self.steppers(ADAPTIVE, &tableau, f)?;
            }
        }
        f.write_str("#endif\n")
    }
}

impl Source {
    fn steppers(&self, text: &'static str, tableau: &Tableau, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let weights = || tableau.rows().into_iter().flatten();
        let mut rest = text;
        // Words of capitals are places; everything between is the same for all systems.
        while let Some((before, word, after)) = next_word(rest) {
            f.write_str(before)?;
            match word {
                "NAME" => f.write_str(self.name)?,
                "RK8_NODES" => numbers(f, tableau.nodes().iter())?,
                "RK8_WEIGHTS" => numbers(f, weights())?,
                "RK8_COUNT" => write!(f, "{}", weights().count())?,
                "ERROR5_WEIGHTS" => numbers(f, tableau.error_weights()[0].iter())?,
                "ERROR3_WEIGHTS" => numbers(f, tableau.error_weights()[1].iter())?,
                "DENSE_NODES" => numbers(f, tableau.dense_nodes().iter())?,
                "DENSE_WEIGHTS" => numbers(f, tableau.dense_rows().into_iter().flatten())?,
                _ => numbers(f, tableau.dense_terms().iter().flatten())?,
            }
            rest = after;
        }
        f.write_str(rest)
    }
}

/// The words that stand for something else.
const PLACES: [&str; 9] = [
    "NAME",
    "RK8_NODES",
    "RK8_WEIGHTS",
    "RK8_COUNT",
    "ERROR5_WEIGHTS",
    "ERROR3_WEIGHTS",
    "DENSE_NODES",
    "DENSE_WEIGHTS",
    "DENSE_TERMS",
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

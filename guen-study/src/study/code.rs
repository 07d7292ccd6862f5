//! The Rust code to write for a setting.

/// The origin of `system` in the code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// The constants, or whatever else can be made anew over a real.
    WithScalar,
    /// A system in doubles: a form, or closures.
    Given,
}

impl Origin {
    /// The lines before the method.
    fn system(self) -> &'static str {
        match self {
            Self::WithScalar => {
                "use guen::{WithScalar, prelude::*};\nlet system = system.with_scalar::<f64>()?;\n"
            }
            Self::Given => "use guen::prelude::*;\n",
        }
    }
}

/// The code that runs a method of guen's over a real. It expects the constants (or whatever the study was made of) as
/// `system` and the initial state as `start`, an array of doubles, and makes the end state of it.
pub(super) fn run(
    origin: Origin,
    real: &str,
    method: &str,
    argument: Argument,
    setting: f64,
    span: (f64, f64),
) -> String {
    let (t0, t1) = span;
    // `f64` and `f32` are there without being named.
    let own = if real.starts_with('f') { String::new() } else { format!("use guen::{real};\n") };
    let step = if real == "f64" { format!("{setting:?}") } else { format!("R::from_f64({setting:?})") };
    let made = match argument {
        Argument::Step => format!("{method}::new({step})"),
        Argument::Tolerances => format!("{method}::new({setting:?}, {setting:?})"),
    };
    if real == "f64" {
        let system = origin.system();
        return format!(
            "{system}let method = {made};\n\
             let end = Integration::new(&system, {t0:?}, &start).run(&method, {t1:?})?.state;\n"
        );
    }
    format!(
        "use guen::{{WithScalar, prelude::*}};\n\
         {own}\
         type R = {real};\n\
         let system = system.with_scalar::<R>()?;\n\
         let method = {made};\n\
         let (t0, t1) = (R::from_f64({t0:?}), R::from_f64({t1:?}));\n\
         let start = start.map(R::from_f64);\n\
         let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);\n"
    )
}

/// The code for a number of evaluations.
pub(super) fn bounded(origin: Origin, constructor: &str, evaluations: f64, span: (f64, f64)) -> String {
    let ((t0, t1), system) = (span, origin.system());
    format!(
        "{system}let end = Bounded::<f64>::{constructor}({evaluations}).advance(&system, {t0:?}, &start, {t1:?})?.state;\n"
    )
}

/// The code for lanes.
pub(super) fn lanes(choice: &str, method: &str, step: f64, span: (f64, f64)) -> String {
    let (t0, t1) = span;
    let method = if method == "RK8" { format!("Rk8::new({step:?})") } else { format!("Rk4::new({step:?})") };
    let choice =
        if choice == "f64" { String::new() } else { format!(".with_scalar::<guen::{choice}Functions>()") };
    format!(
        "use guen::{{WithScalar, prelude::*, study::Ensemble}};\n\
         let system = system.with_scalar::<f64>()?;\n\
         let ensemble = Ensemble::of_states(system, starts){choice};\n\
         let ends = ensemble.integrate(&{method}, {t0:?}, {t1:?});\n"
    )
}

/// The argument of a constructor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Argument {
    /// `Method::new(step)`.
    Step,
    /// `Method::new(rtol, atol)`.
    Tolerances,
}

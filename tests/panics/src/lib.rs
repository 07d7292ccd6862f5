//! Hot paths of several systems, each as a symbol `system_path` of its own: constants, a state, a time, a step and a span
//! come in, so that nothing is known when this is compiled; the state reached goes out.
#![no_std]

#[macro_use]
#[path = "../../../workshop/guen-benchmarks/src/declarations.rs"]
mod declarations;
mod paths;
mod systems;

/// What a panic comes to. Out of line: where it is linked, something can panic. Only where panics abort: elsewhere `std`
/// brings its own.
#[cfg(panic = "abort")]
#[panic_handler]
fn handler(_: &core::panic::PanicInfo<'_>) -> ! {
    halted()
}

#[cfg(panic = "abort")]
#[inline(never)]
fn halted() -> ! {
    loop {
        core::hint::spin_loop();
    }
}

/// Something that can panic: whoever looks for the handler has to find it here.
#[unsafe(no_mangle)]
extern "C" fn probe_panics(constants: &[f64; 4], _: &mut f64, t: f64, _: f64, _: f64) -> bool {
    constants[t as usize] > 0.0
}

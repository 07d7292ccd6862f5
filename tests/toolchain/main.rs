//! Tests that call cargo, the compiler or the linker.

#[macro_use]
extern crate guen_benchmarks;

mod assembly;
mod bare;
mod commands;
mod elf;
mod hygiene;
mod kernels;
mod messages;
mod no_std;
mod panics;
mod rustdoc;
mod source;
mod taylor_source;

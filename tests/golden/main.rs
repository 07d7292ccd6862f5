//! Texts that are compared with files: operations, Taylor series, messages. `GUEN_BLESS=1 cargo test -p guen-tests --test
//! golden` writes the files anew.

#[path = "../../workshop/guen-measure/src/large_systems.rs"]
#[allow(dead_code, reason = "the others belong to other tests")]
mod large_systems;

mod costs;
mod linearizations;
mod lines;
mod messages;
mod sensors;
mod series;
mod signatures;

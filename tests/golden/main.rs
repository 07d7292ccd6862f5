//! Texts that are compared with files: operations, Taylor series, messages. `GUEN_BLESS=1 cargo test -p guen-tests --test
//! golden` writes the files anew.

mod costs;
mod messages;
mod series;

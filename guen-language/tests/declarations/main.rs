//! Declarations as text: what is derived of them, at which token their faults are reported, and what their programs compute.

mod angles;
mod carried;
mod common;
mod corpus;
mod damage;
mod drawn;
mod families;
mod hints;
mod imports;
mod large_costs;
mod limbs;
mod outline;
mod poles;
mod redundant;
mod restricted;
mod rows_of_bars;
mod scenes;
mod signs;
mod singularities;
mod spans;
mod structure;
mod unsigned;
mod vehicles;
mod wheels;

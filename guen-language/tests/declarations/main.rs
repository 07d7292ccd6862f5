//! Declarations as text: what is derived of them, at which token their faults are reported, and what their programs compute.

mod absolute_values;
mod angles;
mod carried;
mod common;
mod corpus;
mod families;
mod functions;
mod hints;
mod imports;
mod large_costs;
mod limbs;
mod outline;
mod poles;
mod random_declarations;
mod rates;
mod redundant;
mod restricted;
mod rows_of_bars;
mod scenes;
mod singularities;
mod spans;
mod structure;
mod token_damage;
mod unsigned;
mod vehicles;
mod wheels;

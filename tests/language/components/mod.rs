//! Components: their ways to the systems that use them, the structs that are generated, the motion.

mod library;
mod ways;

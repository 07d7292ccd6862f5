//! Nothing: the manifest is what this package is for.

#![no_std]
#![forbid(unsafe_code)]

//! What the pages say, against what is there: blocks, executables, links, pointers, tables of manifests, first lines of documentation, and the places of `unsafe`.

mod blocks;
mod executables;
mod few_lines;
mod first_lines;
mod imports;
mod links;
mod manifests;
mod operations;
mod pointers;
mod unsafe_code;

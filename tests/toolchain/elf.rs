//! The symbols of an executable with their sizes: as much of the ELF format as that takes (System V ABI, chapter 4).

use std::collections::BTreeMap;

/// The functions and objects of a 64-bit little-endian file; `None` if it is no such file.
pub fn symbols(file: &[u8]) -> Option<BTreeMap<String, u64>> {
    const SYMBOL_TABLE: u32 = 2;
    const SYMBOL_SIZE: usize = 24;
    const FUNCTION_OR_OBJECT: [u8; 2] = [1, 2];
    if file.get(..6)? != [0x7f, b'E', b'L', b'F', 2, 1] {
        return None;
    }
    let number = |place: usize, size: usize| {
        let bytes = file.get(place..place + size)?;
        Some(bytes.iter().rev().fold(0_u64, |value, byte| value << 8 | u64::from(*byte)))
    };
    let at = |place: usize, size: usize| number(place, size).map(|value| value as usize);
    let (sections, size, count) = (at(0x28, 8)?, at(0x3a, 2)?, at(0x3c, 2)?);
    let mut found = BTreeMap::new();
    for section in (0..count).map(|k| sections + k * size) {
        if number(section + 4, 4)? != u64::from(SYMBOL_TABLE) {
            continue;
        }
        let (start, length, names) = (at(section + 0x18, 8)?, at(section + 0x20, 8)?, at(section + 0x28, 4)?);
        let names = at(sections + names * size + 0x18, 8)?;
        for symbol in (start..start + length).step_by(SYMBOL_SIZE) {
            let defined = number(symbol + 6, 2)? != 0;
            if defined && FUNCTION_OR_OBJECT.contains(&(file.get(symbol + 4)? & 0xf)) {
                let name = file.get(names + at(symbol, 4)?..)?;
                let end = name.iter().position(|byte| *byte == 0)?;
                let name = String::from_utf8_lossy(&name[..end]).into_owned();
                found.insert(name, number(symbol + 16, 8)?);
            }
        }
    }
    Some(found)
}

//! The words that the language knows, in one place: functions, sections, reserved names, the keywords of Rust, and
//! the known word that an unknown one was probably meant to be.

use proc_macro2::Ident;

/// Functions of scalars.
pub const SCALAR_FUNCTIONS: &[&str] = &[
    "sin", "cos", "tan", "cot", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "ln", "sqrt",
    "abs", "sign", "floor", "min", "max", "clamp", "select",
];

/// The time derivative and the functions that make or take vectors and rotations.
pub const SPATIAL_FUNCTIONS: &[&str] = &[
    "dot",
    "vec",
    "inner",
    "cross",
    "norm",
    "unit",
    "rot_x",
    "rot_y",
    "rot_z",
    "rot",
    "quaternion",
    "transpose",
    "angular_velocity",
    "angular_velocity_body",
];

/// Functions of a range: `sum(i in 0..n: e)`.
pub const FOLDS: &[&str] = &["sum", "product"];

/// Reserved words that are not functions.
pub const RESERVED_WORDS: &[&str] = &[
    "t",
    "pi",
    "π",
    "at",
    "along",
    "diag",
    "sym",
    "energy",
    "reactions",
    "operators",
    "linearization",
    "taylor",
];

/// Names that begin with this belong to the expansion.
pub const RESERVED_PREFIX: &str = "__guen";

/// Behind the name of a coordinate: the name of its rate, where the macro chooses it as a parameter.
pub(crate) const RATE_SUFFIX: &str = "_rate";

/// The sections of a system, in the order in which a help lists them.
pub const SECTIONS: &[&str] = &[
    "count",
    "constants",
    "functions",
    "inputs",
    "coordinates",
    "let",
    "fn",
    "parameters",
    "constraints",
    "holonomic",
    "kinetic_energy",
    "particles",
    "bodies",
    "gravity",
    "force_function",
    "potential_energy",
    "states",
    "forces",
    "switches",
    "contacts",
    "resets",
    "modes",
    "outputs",
    "component",
    "use",
    "provide",
    "scene",
];

/// Other names of `parameters`: those of other tools.
pub const PARAMETER_ALIASES: &[&str] = &["quasi_velocities", "speeds"];

/// The statements of a scene.
pub const SCENE_STATEMENTS: &[&str] = &["track", "fix", "provide", "modes"];

/// The fields of a body.
pub const BODY_FIELDS: &[&str] = &["mass", "inertia", "center", "orientation"];

/// Words of neighbouring languages and the section that does their work here.
const SECTION_SYNONYMS: &[(&str, &str)] = &[
    ("variables", "coordinates"),
    ("vars", "coordinates"),
    ("generalized_coordinates", "coordinates"),
    ("generalised_coordinates", "coordinates"),
    ("dofs", "coordinates"),
    ("control", "inputs"),
    ("const", "constants"),
    ("t", "kinetic_energy"),
    ("v", "potential_energy"),
    ("positions", "coordinates"),
    ("controls", "inputs"),
    ("quasivelocities", "parameters"),
    ("velocities", "parameters"),
    ("nonholonomic", "constraints"),
    ("potential", "potential_energy"),
    ("kinetic", "kinetic_energy"),
    ("rigid_bodies", "bodies"),
    ("masses", "particles"),
    ("points", "particles"),
    ("loads", "forces"),
    ("odes", "states"),
    ("first_order", "states"),
    ("auxiliary_states", "states"),
    ("filters", "states"),
    ("integrators", "states"),
    ("function", "functions"),
    ("tables", "functions"),
    ("table", "functions"),
    ("lookups", "functions"),
    ("external", "functions"),
    ("curves", "functions"),
    ("events", "resets"),
    ("callbacks", "resets"),
    ("reinit", "resets"),
    ("jumps", "resets"),
];

/// Items of a generated module, and names that generated code uses for itself or for types of Rust.
const GENERATED_ITEMS: &[&str] = &[
    "State",
    "Prepared",
    "Coordinates",
    "Momenta",
    "Residuals",
    "Reactions",
    "Inputs",
    "Outputs",
    "Driven",
    "Bracket",
    "f64",
    "f32",
    "usize",
    "bool",
    "str",
    "u32",
    "i32",
    "i64",
    "u8",
    "program",
    "placed",
    "missing",
];

/// Constants of a generated module.
const GENERATED_CONSTANTS: &[&str] = &[
    "CATASTATIC",
    "CLASS",
    "CONSERVATIVE",
    "COST",
    "DOMAIN",
    "DOMAIN_REASONS",
    "FUNCTIONS",
    "GROWTH",
    "GROWTH_IS_COMPLETE",
    "INFO",
    "INTEGRABLE",
    "LATEX",
    "LEVELS",
    "LINEARIZATION_COST",
    "MODES",
    "MODE_INFO",
    "PREPARE_COST",
    "REDUCED",
    "REPORT",
    "SCLERONOMIC",
    "SINGULARITIES",
    "SOURCE",
    "SWITCHES",
];

/// The struct of the states of all contacts.
pub(crate) const MODES: &str = "Mode";

/// The struct and the module of a carried form; nothing else in the module of a level may have their names.
pub(crate) const CARRIED_ITEMS: [&str; 2] = ["Carried", "carried"];

/// Strict and reserved keywords of Rust in any edition.
const RUST_KEYWORDS: &[&str] = &[
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn",
    "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop",
    "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return", "Self", "self",
    "static", "struct", "super", "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use",
    "virtual", "where", "while", "yield", "_",
];

/// The place in the text of a name where the indices at its end begin: `q[3]` is `q` and `[3]`.
fn stem_length(text: &str) -> usize {
    let mut end = text.len();
    while text[..end].ends_with(']') {
        let Some(start) = text[..end].rfind('[') else { break };
        end = start;
    }
    end
}

/// The name of a part of what has a name: `w_x` of `w`, `w_x[3]` of `w[3]`.
pub(crate) fn suffixed(text: &str, suffix: &str) -> String {
    let (stem, indices) = text.split_at(stem_length(text));
    format!("{stem}{suffix}{indices}")
}

/// The name without its suffix, if it has it: `w[3]` of `w_x[3]`.
pub(crate) fn without_suffix(text: &str, suffix: &str) -> Option<String> {
    let (stem, indices) = text.split_at(stem_length(text));
    Some(format!("{}{indices}", stem.strip_suffix(suffix)?))
}

/// The name of the array that an entry belongs to; a name that is no entry is its own.
pub(crate) fn array_of(text: &str) -> &str {
    &text[..stem_length(text)]
}

/// Whether a word is a function of the language.
pub fn is_function(word: &str) -> bool {
    SCALAR_FUNCTIONS.contains(&word) || SPATIAL_FUNCTIONS.contains(&word)
}

/// Whether a declaration may not use this name (given without `r#`).
pub fn is_reserved(word: &str) -> bool {
    is_function(word) || RESERVED_WORDS.contains(&word) || word.starts_with(RESERVED_PREFIX)
}

/// The parameter of generic code, which hides items of that name.
pub(crate) const REAL: &str = "R";

/// Whether a system cannot have this name, because its module has an item of that name.
pub fn is_generated_item(word: &str) -> bool {
    let number = word.strip_prefix('X');
    GENERATED_ITEMS.contains(&word)
        || word.starts_with(RESERVED_PREFIX)
        || number.is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()))
}

/// Whether a scene or the states of a contact cannot have this name: their types may be values, too, as constants are.
pub(crate) fn is_generated_type_or_constant(word: &str) -> bool {
    is_generated_item(word) || GENERATED_CONSTANTS.contains(&word)
}

/// Whether a word in a pattern may mean an item: the operators and constants of a generated module are in capitals,
/// and so are the variants of the prelude.
pub fn is_pattern(word: &str) -> bool {
    is_generated_item(word)
        || matches!(word, "None" | "Some" | "Ok" | "Err")
        || (word.len() > 1 && word.chars().all(|c| c.is_ascii_uppercase() || c == '_' || c.is_ascii_digit()))
}

/// Whether a word is a keyword of Rust, so that a name must be written with `r#`.
pub fn is_rust_keyword(word: &str) -> bool {
    RUST_KEYWORDS.contains(&word)
}

/// Whether a keyword of Rust may be written `r#word`.
pub fn can_be_raw(word: &str) -> bool {
    !matches!(word, "self" | "Self" | "super" | "crate" | "_")
}

/// Returns what to write for a word that no single section stands for.
pub fn instead_of_section(word: &str) -> Option<&'static str> {
    Some(match word.to_lowercase().as_str() {
        "params" | "param" | "parameter" => {
            "physical constants stand in `constants`, quasi-velocities in `parameters`"
        }
        "lagrangian" | "l" | "energy" | "energies" => {
            "write `kinetic_energy = e;` and `potential_energy = e;`: the equations follow from both"
        }
        "u" => "write `force_function = e;`, or its negative as `potential_energy = e;`",
        "extends" | "connect" | "connector" | "model" | "block" | "class" | "inherits" => {
            "a part is declared by `component Name(a: vector) { .. }`, and used by `use Name as name { a: e }`"
        }
        "include" | "import" | "replicate" | "attach" | "instance" => {
            "a component is imported with `use` of Rust in front of the system, and used by `use Name as name { a: e }`"
        }
        "match" | "while" | "loop" => {
            "entries repeat as `for i in 0..n { .. }`, and are chosen by `if i < k { .. } else { .. }`"
        }
        _ => return None,
    })
}

/// The section that an unknown word was probably meant to be.
pub fn nearest_section(word: &str) -> Option<&'static str> {
    let lower = word.to_lowercase();
    SECTION_SYNONYMS
        .iter()
        .find(|(synonym, _)| *synonym == lower)
        .map(|(_, section)| *section)
        .or_else(|| nearest(word, SECTIONS.iter().copied()))
}

/// The candidate with the least number of edits to `word`, the first of equals; none where a third of the word
/// or more would have to change. A difference in case alone always counts as near.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let letters: Vec<char> = word.to_lowercase().chars().collect();
    let allowed = (letters.len() / 3).max(1);
    let mut best: Option<(usize, &'a str)> = None;
    for candidate in candidates {
        let other: Vec<char> = candidate.to_lowercase().chars().collect();
        // A single letter is one edit away from every other: such a hint would say nothing.
        if letters.len().max(other.len()) < 2 && letters != other {
            continue;
        }
        let distance = edits(&letters, &other);
        if distance <= allowed && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Number of insertions, deletions, replacements and exchanges of neighbours that lead from one word to another.
fn edits(from: &[char], to: &[char]) -> usize {
    let mut before_last: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=to.len()).collect();
    for (i, a) in from.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, b) in to.iter().enumerate() {
            let mut least = (last[j] + usize::from(a != b)).min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && *a == to[j - 1] && from[i - 1] == *b {
                least = least.min(before_last[j - 1] + 1);
            }
            row.push(least);
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last[to.len()]
}

/// A list of words for a message: `` `a`, `b`, `c` ``.
pub fn quoted<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    words.into_iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

/// The name of the module beside the struct: `RollingHoop` becomes `rolling_hoop`; where that is the name itself, what
/// it is a module of (a system, a scene) is appended.
pub fn module_name(system: &Ident, what: &str) -> Ident {
    let text = system.to_string();
    let text = text.strip_prefix("r#").unwrap_or(&text);
    let letters: Vec<char> = text.chars().collect();
    let mut name = String::new();
    for (i, letter) in letters.iter().enumerate() {
        let starts_word = letter.is_uppercase()
            && i > 0
            && (letters[i - 1].is_lowercase()
                || letters[i - 1].is_numeric()
                || letters.get(i + 1).is_some_and(|next| next.is_lowercase()));
        if starts_word && letters[i - 1] != '_' {
            name.push('_');
        }
        name.extend(letter.to_lowercase());
    }
    if name == text {
        name.push('_');
        name.push_str(what);
    }
    if is_rust_keyword(&name) {
        if can_be_raw(&name) {
            return Ident::new_raw(&name, system.span());
        }
        name.push('_');
    }
    Ident::new(&name, system.span())
}

/// The name of the type of something's states: `left_foot` becomes `LeftFoot`.
pub fn type_name(name: &str) -> String {
    let mut text = String::new();
    let mut begins = true;
    for letter in name.chars() {
        match letter {
            '_' => begins = true,
            _ if begins => {
                text.extend(letter.to_uppercase());
                begins = false;
            }
            _ => text.push(letter),
        }
    }
    if text.starts_with(|first: char| first.is_alphabetic()) { text } else { format!("_{text}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_found() {
        assert_eq!(nearest_section("coordinate"), Some("coordinates"));
        assert_eq!(nearest_section("Constants"), Some("constants"));
        assert_eq!(nearest_section("kinetic_enregy"), Some("kinetic_energy"));
        assert_eq!(nearest_section("quasivelocities"), Some("parameters"));
        assert_eq!(nearest_section("lagrangian"), None);
        assert_eq!(nearest("theat", ["phi", "theta", "psi"]), Some("theta"));
        assert_eq!(nearest("x", ["y", "z"]), None);
    }

    #[test]
    fn reserved_words() {
        for word in ["sin", "dot", "t", "pi", "along", "sym", "operators", "__guen_x"] {
            assert!(is_reserved(word), "{word}");
        }
        for word in ["x", "theta", "mass", "center", "θ"] {
            assert!(!is_reserved(word), "{word}");
        }
    }
}

//! Texts as cells of comma-separated values.

/// Characters that a spreadsheet takes for the beginning of a formula, the wide forms of East Asian keyboards among
/// them; a tabulator or a carriage return may be skipped before it.
const FORMULA: [char; 10] = ['=', '+', '-', '@', '\t', '\r', '＝', '＋', '－', '＠'];

/// A text as a cell (RFC 4180): in quotation marks where it has characters that could end a cell, and with an apostrophe
/// before it where a spreadsheet would take it for a formula and run it.
///
/// For texts only. Numbers are written as they are, so that they stay numbers.
pub(crate) fn text(text: &str) -> String {
    let guard = if text.trim_start_matches(' ').starts_with(FORMULA) { "'" } else { "" };
    if text.contains([',', ';', '\t', '"', '\n', '\r']) || !guard.is_empty() {
        format!("\"{guard}{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::text;

    #[test]
    fn formulas_are_texts_and_texts_stay() {
        for (given, cell) in [
            ("theta", "theta"),
            ("x, y", "\"x, y\""),
            ("x; y", "\"x; y\""),
            ("5\" disc", "\"5\"\" disc\""),
            ("=1+1", "\"'=1+1\""),
            ("+1", "\"'+1\""),
            ("-x", "\"'-x\""),
            ("@SUM(A1)", "\"'@SUM(A1)\""),
            ("\t=1", "\"'\t=1\""),
            ("\r=1", "\"'\r=1\""),
            ("  =1", "\"'  =1\""),
            ("＝1", "\"'＝1\""),
            ("a=1", "a=1"),
            ("", ""),
        ] {
            assert_eq!(text(given), cell, "{given:?}");
        }
    }
}

//! Comma-separated values as a spreadsheet reads them.

/// The cells of a line, as RFC 4180 has them.
pub fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        match (c, quoted) {
            ('"', true) if chars.peek() == Some(&'"') => {
                cell.push('"');
                chars.next();
            }
            ('"', _) => quoted = !quoted,
            (',', false) => cells.push(std::mem::take(&mut cell)),
            _ => cell.push(c),
        }
    }
    cells.push(cell);
    cells
}

/// Whether a spreadsheet would run the cell.
pub fn runs(cell: &str) -> bool {
    cell.parse::<f64>().is_err()
        && cell.trim_start().starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠'])
}

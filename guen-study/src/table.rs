//! Numbers for people: significant digits, and columns that align at the decimal point.

use std::fmt;

/// The digits shown unless others are chosen.
const DIGITS: usize = 6;
/// The most digits that say something of an `f64`.
const MOST_DIGITS: usize = 17;
/// Decimal exponents from which on, and below which, a number is written with an exponent.
const PLAIN: std::ops::Range<i32> = -4..6;
/// The space between two columns.
const GAP: &str = "  ";

/// A number with the given count of significant digits, between 1 and 17.
///
/// A number that fewer digits give exactly is written with fewer; digits before the decimal point are never
/// replaced by zeros; below `1e-4`, and from `1e6` on unless all the digits are asked for, there is an exponent.
///
/// ```
/// use guen_study::significant;
///
/// assert_eq!(significant(std::f64::consts::PI, 4), "3.142");
/// assert_eq!(significant(0.5, 4), "0.5");
/// assert_eq!(significant(0.3 + 1e-12, 4), "0.3000");
/// assert_eq!(significant(-1.23456e-9, 3), "-1.23e-9");
/// assert_eq!(significant(12345.6, 3), "12346");
/// ```
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let digits = digits.clamp(1, MOST_DIGITS);
    let scientific = format!("{value:.*e}", digits - 1);
    let Some((mantissa, exponent)) = scientific.split_once('e') else { return scientific };
    // Taken from the rounded text: 9.996 to three digits is 10.0.
    let power: i32 = exponent.parse().unwrap_or(0);
    if PLAIN.contains(&power) || power >= 0 && power < digits as i32 {
        let decimals = (digits as i32 - 1 - power).max(0) as usize;
        shortened(&format!("{value:.decimals$}"), "", value)
    } else {
        shortened(mantissa, &format!("e{exponent}"), value)
    }
}

/// The number without zeros at the end of its fraction, if that is the value exactly.
fn shortened(number: &str, exponent: &str, value: f64) -> String {
    if number.contains('.') {
        let short = format!("{}{exponent}", number.trim_end_matches('0').trim_end_matches('.'));
        if short.parse() == Ok(value) {
            return short;
        }
    }
    format!("{number}{exponent}")
}

/// A table of numbers for a terminal: names on top, columns aligned at the decimal point.
///
/// Displayed without a line feed at its end.
///
/// ```
/// use guen_study::Table;
///
/// let mut table = Table::new(&["t", "theta", "error"]).digits(4).column_digits(2, 2);
/// table.row(&[0.0, 0.3, 0.0]);
/// table.row(&[10.0, -0.123456, 3.14159e-13]);
/// let lines = [
///     "t    theta    error",
///     "--  -------  -------",
///     " 0   0.3     0",
///     "10  -0.1235  3.1e-13",
/// ];
/// assert_eq!(table.to_string(), lines.join("\n"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    columns: Vec<Column>,
    rows: usize,
}

#[derive(Clone, Debug, PartialEq)]
struct Column {
    name: String,
    digits: usize,
    values: Vec<f64>,
}

impl Table {
    /// A table without rows.
    pub fn new(names: &[&str]) -> Self {
        let column = |name: &&str| Column { name: (*name).to_owned(), digits: DIGITS, values: Vec::new() };
        Self { columns: names.iter().map(column).collect(), rows: 0 }
    }

    /// Sets the significant digits of every column, see [`significant`]; otherwise 6.
    pub fn digits(mut self, digits: usize) -> Self {
        for column in &mut self.columns {
            column.digits = digits;
        }
        self
    }

    /// Sets the significant digits of one column.
    ///
    /// # Panics
    ///
    /// If there is no such column.
    pub fn column_digits(mut self, column: usize, digits: usize) -> Self {
        self.columns[column].digits = digits;
        self
    }

    /// Appends a row.
    ///
    /// # Panics
    ///
    /// If it has not as many numbers as the table has columns.
    pub fn row(&mut self, values: &[f64]) -> &mut Self {
        assert_eq!(values.len(), self.columns.len(), "a row needs one number for each column");
        for (column, &value) in self.columns.iter_mut().zip(values) {
            column.values.push(value);
        }
        self.rows += 1;
        self
    }
}

impl Column {
    /// Name, rule and cells, all of the same width.
    fn lines(&self) -> Vec<String> {
        let cells: Vec<String> = self.values.iter().map(|&value| significant(value, self.digits)).collect();
        let halves: Vec<(&str, &str)> =
            cells.iter().map(|cell| cell.split_at(cell.find(['.', 'e']).unwrap_or(cell.len()))).collect();
        let before = halves.iter().map(|(whole, _)| whole.len()).max().unwrap_or(0);
        let after = halves.iter().map(|(_, fraction)| fraction.len()).max().unwrap_or(0);
        let width = self.name.chars().count().max(before + after);
        let before = width - after;
        let mut lines = vec![format!("{:^width$}", self.name), "-".repeat(width)];
        lines.extend(halves.iter().map(|(whole, fraction)| format!("{whole:>before$}{fraction:after$}")));
        lines
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns: Vec<Vec<String>> = self.columns.iter().map(Column::lines).collect();
        for line in 0..self.rows + 2 {
            if line > 0 {
                writeln!(f)?;
            }
            let cells: Vec<&str> = columns.iter().map(|lines| lines[line].as_str()).collect();
            f.write_str(cells.join(GAP).trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_counted_after_rounding() {
        for (value, digits, text) in [
            (9.996, 3, "10.0"),
            (0.000_099_999, 3, "0.000100"),
            (0.0001, 3, "0.0001"),
            (999_999.9, 6, "1.00000e6"),
            (999_999.9, 7, "999999.9"),
            (1e6, 3, "1e6"),
            (1_234_567.0, 9, "1234567"),
            (1000.0, 2, "1000"),
            (-0.0, 5, "0"),
            (1.0 / 3.0, 0, "0.3"),
            (1.0 / 3.0, 99, "0.33333333333333331"),
            (f64::NAN, 3, "NaN"),
            (f64::NEG_INFINITY, 3, "-inf"),
            (5e-324, 3, "4.94e-324"),
            (f64::MAX, 3, "1.80e308"),
        ] {
            assert_eq!(significant(value, digits), text, "{value} to {digits}");
        }
    }

    #[test]
    fn points_align_under_names() {
        let mut table = Table::new(&["t", "a long name", "e"]).digits(3);
        table.row(&[0.0, 1.0, f64::NAN]).row(&[12.5, -123.0, 1e-12]).row(&[100.0, 0.125, 1.0]);
        let expected = [
            "  t    a long name     e",
            "-----  -----------  -------",
            "  0          1      NaN",
            " 12.5     -123        1e-12",
            "100          0.125    1",
        ];
        assert_eq!(table.to_string(), expected.join("\n"));
    }

    #[test]
    fn a_table_without_rows_is_its_head() {
        assert_eq!(Table::new(&["t", "x"]).to_string(), "t  x\n-  -");
    }

    #[test]
    #[should_panic(expected = "one number for each column")]
    fn a_row_must_fit() {
        Table::new(&["t", "x"]).row(&[0.0]);
    }
}

//! Statistics as lines of text, to the last bit, and read again.

use std::fmt::Write as _;

use super::exact_sum::ExactSum;
use super::sketch::Sketch;
use super::statistics::{Group, OfColumn, Plan, Statistics};

impl Statistics {
    /// All counts and sums: equal statistics have equal texts.
    pub(super) fn text(&self) -> String {
        let mut text = format!("motions {} faults {}\n", self.motions, self.faults);
        for group in &self.groups {
            let _ = writeln!(text, "complete {}", group.complete);
            group.sums.iter().for_each(|sum| {
                let _ = writeln!(text, "sum {}", sum.text());
            });
            group.products.iter().for_each(|sum| {
                let _ = writeln!(text, "product {}", sum.text());
            });
            for of in &group.columns {
                let _ = writeln!(text, "column {} {}", of.lone, of.not_finite);
                let [sum, squares] = of.lone_sum.clone().unwrap_or_default();
                let _ = writeln!(text, "sum {}\nproduct {}", sum.text(), squares.text());
                let ends = of.ends.map(|ends| ends.map(|end| format!("{:016x}", end.to_bits())).join(" "));
                let _ = writeln!(text, "ends {}", ends.as_deref().unwrap_or("-"));
                let _ = writeln!(text, "sketch {}", of.sketch.text());
                let bins: Vec<String> = of.bins.iter().map(u64::to_string).collect();
                let _ = writeln!(text, "bins {}", bins.join(","));
            }
        }
        text
    }

    /// Reads what [`text`](Self::text) wrote; none of anything else.
    pub(super) fn parse(plan: &Plan, text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let mut statistics = Self::new(plan.clone());
        let (motions, faults) = field(&mut lines, "motions")?.split_once(" faults ")?;
        (statistics.motions, statistics.faults) = (motions.parse().ok()?, faults.parse().ok()?);
        statistics.groups.iter_mut().try_for_each(|group| group.read(&mut lines))?;
        lines.next().is_none().then_some(statistics)
    }
}

/// The rest of the next line behind a word.
fn field<'a>(lines: &mut std::str::Lines<'a>, word: &str) -> Option<&'a str> {
    lines.next()?.strip_prefix(word)?.strip_prefix(' ')
}

impl Group {
    fn read(&mut self, lines: &mut std::str::Lines<'_>) -> Option<()> {
        self.complete = field(lines, "complete")?.parse().ok()?;
        for sum in &mut self.sums {
            *sum = ExactSum::parse(field(lines, "sum")?)?;
        }
        for sum in &mut self.products {
            *sum = ExactSum::parse(field(lines, "product")?)?;
        }
        self.columns.iter_mut().try_for_each(|of| of.read(lines))
    }
}

impl OfColumn {
    fn read(&mut self, lines: &mut std::str::Lines<'_>) -> Option<()> {
        let (lone, not_finite) = field(lines, "column")?.split_once(' ')?;
        (self.lone, self.not_finite) = (lone.parse().ok()?, not_finite.parse().ok()?);
        let sums = [ExactSum::parse(field(lines, "sum")?)?, ExactSum::parse(field(lines, "product")?)?];
        self.lone_sum = (self.lone > 0).then_some(sums);
        let ends = field(lines, "ends")?;
        if ends != "-" {
            let (low, high) = ends.split_once(' ')?;
            let number = |text: &str| u64::from_str_radix(text, 16).ok().map(f64::from_bits);
            self.ends = Some([number(low)?, number(high)?]);
        }
        self.sketch = Sketch::parse(field(lines, "sketch")?)?;
        let bins = field(lines, "bins")?;
        let counts: Vec<u64> = bins
            .split(',')
            .filter(|_| !bins.is_empty())
            .map(|count| count.parse().ok())
            .collect::<Option<_>>()?;
        (counts.len() == self.bins.len()).then(|| self.bins = counts)
    }
}

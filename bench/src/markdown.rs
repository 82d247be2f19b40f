//! Tables in Markdown, and numbers as they are read.

/// A table that grows row by row.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    columns: usize,
    text: String,
}

impl Table {
    /// With these titles.
    pub(crate) fn new(titles: &[&str]) -> Table {
        let mut table = Table {
            columns: titles.len(),
            text: String::new(),
        };
        table.line(titles.iter().map(|title| (*title).to_owned()));
        let aligned = (0..titles.len()).map(|index| if index == 0 { "---" } else { "---:" });
        table.line(aligned.map(str::to_owned));
        table
    }

    /// One more row.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.line(cells);
    }

    fn line(&mut self, cells: impl IntoIterator<Item = String>) {
        let cells: Vec<String> = cells.into_iter().collect();
        debug_assert_eq!(
            cells.len(),
            self.columns,
            "a row has as many cells as titles"
        );
        self.text.push_str(&format!("| {} |\n", cells.join(" | ")));
    }

    /// The table's text, which ends with a line's end.
    pub(crate) fn text(self) -> String {
        self.text
    }
}

/// A number with three digits that count: `0.00123`, `45.6`, `12 300`.
pub(crate) fn digits(value: f64) -> String {
    rounded(value, 3)
}

/// A number with so many digits that count.
pub(crate) fn rounded(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return "-".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = format!("{:.*e}", (digits - 1).max(0) as usize, value.abs());
    let exponent: i32 = exponent
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse().ok())
        .unwrap_or(0);
    let decimals = digits - 1 - exponent;
    if decimals >= 0 {
        return format!("{value:.*}", decimals as usize);
    }
    let unit = 10_f64.powi(-decimals);
    grouped((value / unit).round() * unit)
}

/// A whole number with a space between thousands.
pub(crate) fn grouped(value: f64) -> String {
    let text = format!("{:.0}", value.abs());
    let first = text.len() % 3;
    let mut parts: Vec<&str> = Vec::new();
    if first > 0 {
        parts.push(&text[..first]);
    }
    parts.extend((first..text.len()).step_by(3).map(|at| &text[at..at + 3]));
    let sign = if value < 0.0 { "-" } else { "" };
    format!("{sign}{}", parts.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_the_digits_that_count() {
        let shown: Vec<String> = [0.001_234_5, 45.64, 999.6, 12_345.0, -0.5, f64::NAN, 0.0]
            .map(digits)
            .to_vec();
        assert_eq!(
            shown,
            ["0.00123", "45.6", "1 000", "12 300", "-0.500", "-", "0"]
        );
    }

    #[test]
    fn a_table_has_titles_a_rule_and_rows() {
        let mut table = Table::new(&["what", "ns"]);
        table.row(["solve".to_owned(), "7".to_owned()]);
        assert_eq!(
            table.text(),
            "| what | ns |\n| --- | ---: |\n| solve | 7 |\n"
        );
    }
}

//! Which of the stored rows are exported.

use std::str::FromStr;

/// Which of the stored rows are exported. Rows are never interpolated: what is exported was stored.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Thinning {
    /// All of them.
    #[default]
    All,
    /// The first and every n-th after it.
    Every(usize),
    /// Those from one time to another; with a step, those nearest to the times of that step.
    Times {
        /// First time [s].
        from_s: f64,
        /// Last time [s].
        to_s: f64,
        /// Step [s].
        step_s: Option<f64>,
    },
}

impl Thinning {
    /// Indices of the rows out of their times [s], both ascending.
    pub(crate) fn rows(&self, times_s: &[f64]) -> Vec<usize> {
        match *self {
            Thinning::All => (0..times_s.len()).collect(),
            Thinning::Every(n) => (0..times_s.len()).step_by(n.max(1)).collect(),
            Thinning::Times {
                from_s,
                to_s,
                step_s,
            } => {
                // Times of rows are multiples of an interval and carry its rounding.
                let slack = 1e-9 * times_s.last().map_or(1.0, |last| last.abs().max(1.0));
                let first = times_s.partition_point(|time| *time < from_s - slack);
                let end = times_s.partition_point(|time| *time <= to_s + slack);
                match step_s {
                    None => (first..end).collect(),
                    Some(step_s) => {
                        let reached_s = times_s[..end].last().map_or(to_s, |last| last.min(to_s));
                        let last = ((reached_s - from_s) / step_s + 1e-9).floor();
                        nearest(&times_s[..end], first, from_s, step_s, last)
                    }
                }
            }
        }
    }
}

/// Of the rows from `first` on those that are nearest to `from_s + k step_s`, k from 0 to `last`;
/// each once.
fn nearest(times_s: &[f64], first: usize, from_s: f64, step_s: f64, last: f64) -> Vec<usize> {
    let mut rows: Vec<usize> = Vec::new();
    let mut best: Option<(f64, f64)> = None;
    for (row, time) in times_s.iter().enumerate().skip(first) {
        let steps = ((time - from_s) / step_s).max(0.0);
        let target = steps.round().min(last);
        let distance = (steps - target).abs();
        match best {
            // Rows that are nearest to the same time: the nearer one stays.
            Some((taken, taken_distance)) if taken == target => {
                if distance < taken_distance {
                    rows.pop();
                    rows.push(row);
                    best = Some((taken, distance));
                }
            }
            _ => {
                rows.push(row);
                best = Some((target, distance));
            }
        }
    }
    rows
}

impl FromStr for Thinning {
    type Err = String;

    /// `FROM:TO` or `FROM:TO:STEP` in seconds; a missing end is that of the results.
    fn from_str(text: &str) -> Result<Self, String> {
        let usage = || "write FROM:TO or FROM:TO:STEP in seconds, such as 100:200:0.5".to_owned();
        let parts: Vec<&str> = text.split(':').map(str::trim).collect();
        let number = |text: &str, missing: f64| -> Result<f64, String> {
            if text.is_empty() {
                return Ok(missing);
            }
            let value: f64 = text
                .trim_end_matches('s')
                .trim()
                .parse()
                .map_err(|_| usage())?;
            if value.is_finite() {
                Ok(value)
            } else {
                Err(usage())
            }
        };
        let (from, to, step) = match parts.as_slice() {
            [from, to] => (from, to, None),
            [from, to, step] => (from, to, Some(*step)),
            _ => return Err(usage()),
        };
        let (from_s, to_s) = (number(from, 0.0)?, number(to, f64::MAX)?);
        if to_s < from_s {
            return Err(format!(
                "{to} is before {from}: write the earlier time first"
            ));
        }
        let step_s = match step {
            None | Some("") => None,
            Some(step) => Some(number(step, 0.0)?),
        };
        if step_s.is_some_and(|step| step <= 0.0) {
            return Err("the step must be greater than zero".to_owned());
        }
        Ok(Thinning::Times {
            from_s,
            to_s,
            step_s,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str, times: &[f64]) -> Vec<usize> {
        text.parse::<Thinning>().expect("valid").rows(times)
    }

    #[test]
    fn every_starts_at_the_first_row() {
        let times: Vec<f64> = (0..10).map(f64::from).collect();
        assert_eq!(Thinning::Every(4).rows(&times), [0, 4, 8]);
        assert_eq!(Thinning::All.rows(&times).len(), 10);
        assert!(Thinning::Every(4).rows(&[]).is_empty());
    }

    #[test]
    fn stretches_include_both_ends_despite_rounding() {
        let times: Vec<f64> = (0..100).map(|n| f64::from(n) * 0.1).collect();
        assert_eq!(rows("0.3:0.7", &times), [3, 4, 5, 6, 7]);
        assert_eq!(rows("9.8:", &times), [98, 99]);
        assert_eq!(rows(":0.1", &times), [0, 1]);
        assert_eq!(rows("0.3 s : 0.7 s", &times), [3, 4, 5, 6, 7]);
        assert!(rows("20:30", &times).is_empty());
    }

    #[test]
    fn a_step_takes_the_nearest_rows_each_once() {
        let times: Vec<f64> = (0..100).map(|n| f64::from(n) * 0.1).collect();
        assert_eq!(rows("1:2:0.5", &times), [10, 15, 20]);
        // A step finer than the rows gives every row, and one that does not fit gives the nearest.
        assert_eq!(rows("1:1.5:0.01", &times).len(), 6);
        assert_eq!(rows("0:1:0.33", &times), [0, 3, 7, 10]);
        assert_eq!(rows("0:1:0.6", &times), [0, 6]);
        assert_eq!(rows("::5", &times), [0, 50]);
    }

    #[test]
    fn what_is_no_stretch_is_refused_with_the_way_to_write_it() {
        for text in ["", "5", "1:2:3:4", "a:b", "1:nan", "2:1", "1:2:0", "1:2:-1"] {
            assert!(text.parse::<Thinning>().is_err(), "{text}");
        }
    }
}

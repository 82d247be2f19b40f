//! What the numbers were measured on, with, and when.

use std::path::Path;
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

/// Machine, versions and time of a measurement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Circumstances {
    /// Model of the processor.
    pub processor: String,
    /// Logical processors that this process may use.
    pub processors: usize,
    /// Operating system and architecture.
    pub system: String,
    /// Version of Catenix and the commit it was built from, where known.
    pub catenix: String,
    /// The compiler.
    pub rustc: String,
    /// Day and time (UTC) of the start.
    pub date: String,
    /// The command that repeats it.
    pub command: String,
    /// Processes that wanted to run, averaged over a minute, before and after; this one counts.
    pub load: [Option<f64>; 2],
    /// Elapsed time of the section [s].
    pub elapsed_s: f64,
}

impl Circumstances {
    /// At the start of a measurement.
    pub(crate) fn now(root: &Path, command: String) -> Circumstances {
        Circumstances {
            processor: processor(),
            processors: std::thread::available_parallelism().map_or(1, usize::from),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            catenix: catenix(root),
            rustc: said(Command::new("rustc").arg("--version")).unwrap_or_default(),
            date: date(SystemTime::now()),
            command,
            load: [load(), None],
            elapsed_s: 0.0,
        }
    }
}

/// What a command prints, without the line's end.
pub(crate) fn said(command: &mut Command) -> Option<String> {
    let output = command.output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    (output.status.success() && !text.is_empty()).then_some(text)
}

/// Processes that want to run, averaged over the last minute.
pub(crate) fn load() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/loadavg").ok()?;
    text.split_whitespace().next()?.parse().ok()
}

fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    match (field("model name"), field("cpu family"), field("model\t")) {
        (Some(name), Some(family), Some(model)) => {
            format!("{name} (family {family}, model {model})")
        }
        (Some(name), ..) => name,
        _ => "unknown".to_owned(),
    }
}

fn catenix(root: &Path) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let git = |arguments: &[&str]| said(Command::new("git").current_dir(root).args(arguments));
    match git(&["rev-parse", "--short=10", "HEAD"]) {
        Some(commit) => {
            let changed = git(&["status", "--porcelain", "--", "crates", "Cargo.lock"]).is_some();
            let changed = if changed { ", with changes" } else { "" };
            format!("{version} ({commit}{changed})")
        }
        None => version.to_owned(),
    }
}

/// Day and time in UTC.
fn date(time: SystemTime) -> String {
    let seconds = time.duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    let (year, month, day) = civil(days);
    let (hour, minute) = (rest / 3600, rest % 3600 / 60);
    format!("{year}-{month:02}-{day:02} {hour:02}:{minute:02} UTC")
}

/// Year, month and day of the Gregorian calendar, `days` after 1970-01-01.
fn civil(days: u64) -> (u64, usize, u64) {
    let leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let (mut year, mut left) = (1970, days);
    loop {
        let length = if leap(year) { 366 } else { 365 };
        if left < length {
            break;
        }
        left -= length;
        year += 1;
    }
    let february = if leap(year) { 29 } else { 28 };
    let lengths = [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    for (index, length) in lengths.into_iter().enumerate() {
        if left < length {
            return (year, index + 1, left + 1);
        }
        left -= length;
    }
    (year, 12, left + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn dates_are_those_of_the_calendar() {
        let at = |seconds| date(UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!(at(0), "1970-01-01 00:00 UTC");
        assert_eq!(at(951_782_400), "2000-02-29 00:00 UTC");
        assert_eq!(at(1_798_761_599), "2026-12-31 23:59 UTC");
    }
}

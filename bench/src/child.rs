//! Programs run as processes of their own, and what they cost.

use std::path::Path;
use std::process::{Command, Output};

use serde::de::DeserializeOwned;

/// Runs a command to its end and takes its output.
pub(crate) fn output_of(command: &mut Command) -> Result<Output, String> {
    let name = Path::new(command.get_program())
        .file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default();
    let output = command
        .output()
        .map_err(|error| format!("`{name}` did not start: {error}"))?;
    if output.status.success() {
        return Ok(output);
    }
    let arguments: Vec<_> = command
        .get_args()
        .map(|text| text.to_string_lossy())
        .collect();
    Err(format!(
        "`{name} {}` ended with {}:\n{}",
        arguments.join(" "),
        output.status,
        String::from_utf8_lossy(&output.stderr)
    ))
}

/// Runs a command that prints one JSON document.
pub(crate) fn json_of<T: DeserializeOwned>(command: &mut Command) -> Result<T, String> {
    let output = output_of(command)?;
    let text = String::from_utf8_lossy(&output.stdout);
    // Libraries of others print what they like first; the document is the last line.
    let line = text.trim_end().lines().last().unwrap_or_default();
    serde_json::from_str(line).map_err(|error| {
        let program = command.get_program().to_string_lossy();
        format!("{program} printed no result: {error}\n{text}")
    })
}

/// Runs a command and measures the processor time of its whole process, all threads, user and
/// system [s].
///
/// Processes that ran to their end are added up by the operating system, so the difference over
/// this call is the command's, as long as nothing else is waited for at the same time.
pub(crate) fn cpu_of(command: &mut Command) -> Result<(f64, Output), String> {
    let before = children_cpu()?;
    let output = output_of(command)?;
    Ok((children_cpu()? - before, output))
}

#[cfg(unix)]
fn children_cpu() -> Result<f64, String> {
    use nix::sys::resource::{UsageWho, getrusage};
    use nix::sys::time::TimeVal;
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN).map_err(|error| error.to_string())?;
    let seconds = |time: TimeVal| time.tv_sec() as f64 + 1e-6 * time.tv_usec() as f64;
    Ok(seconds(usage.user_time()) + seconds(usage.system_time()))
}

#[cfg(not(unix))]
fn children_cpu() -> Result<f64, String> {
    Err("processor times of other processes are measured on Unix only".to_owned())
}

/// Largest memory that this process has had resident so far [bytes]; Linux only.
pub(crate) fn own_peak_bytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(1024.0 * kilobytes)
}

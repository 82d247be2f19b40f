//! The viewer's page: its types are checked, it is built again and compared with what is committed,
//! and it runs in a browser against real stores.
//!
//! npm's packages are pinned by `web/package-lock.json`, and none of their install scripts runs. The
//! browser is Debian's Chromium, or the one that `CATENIX_CHROMIUM` names.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::read_back::target_folder;
use crate::steps::{cargo, run_command};

const LOCK: &str = "web/package-lock.json";
const ASSETS: &str = "crates/viewer/assets";
/// Names of the browser on different systems.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Checks, builds, compares and runs the page.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let web = root.join("web");
    let target = target_folder(root)?;
    install(root, &web)?;
    run_command(npm(&web).args(["run", "--silent", "check"]))?;
    compare(root, &web, &target.join("web-assets"))?;
    let browser = browser()?;
    // Built as the tests are, for the whole workspace: with the features that one package alone
    // would ask for, cargo would compile most dependencies again.
    run_command(&mut cargo(root, &["build", "--workspace", "--bins"]))?;
    let program = format!("catenix{}", env::consts::EXE_SUFFIX);
    run_command(
        node(&web)
            // One file after the other: every page draws with the processor.
            .args(["--test", "--test-concurrency=1"])
            .args(test_files(&web)?)
            .env("CATENIX_BIN", target.join("debug").join(program))
            .env("CATENIX_CHROMIUM", browser),
    )
}

/// Installs the pinned packages, unless they are there already.
fn install(root: &Path, web: &Path) -> Result<(), String> {
    let works = |mut command: Command| {
        command
            .arg("--version")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|status| status.success())
    };
    if !works(node(web)) || !works(npm(web)) {
        return Err(
            "the step needs node 20 or newer with npm (Debian and Ubuntu: apt-get install nodejs \
             npm)"
                .to_owned(),
        );
    }
    let wanted = fs::read_to_string(root.join(LOCK))
        .map_err(|error| format!("cannot read {LOCK}: {error}"))?;
    let stamp = web.join("node_modules").join("installed-lock.json");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(());
    }
    run_command(npm(web).args([
        "ci",
        "--ignore-scripts",
        "--no-audit",
        "--no-fund",
        "--loglevel=error",
    ]))?;
    fs::write(&stamp, wanted).map_err(|error| format!("cannot write the stamp: {error}"))
}

/// Builds the page and compares every byte with what is committed.
fn compare(root: &Path, web: &Path, built: &Path) -> Result<(), String> {
    if built.exists() {
        fs::remove_dir_all(built)
            .map_err(|error| format!("cannot empty {}: {error}", built.display()))?;
    }
    run_command(node(web).arg("build.mjs").arg(built))?;
    let committed = root.join(ASSETS);
    let mut names = file_names(built)?;
    names.extend(file_names(&committed)?);
    names.sort();
    names.dedup();
    let differs =
        |name: &&String| fs::read(built.join(name)).ok() != fs::read(committed.join(name)).ok();
    let different: Vec<&str> = names.iter().filter(differs).map(String::as_str).collect();
    if different.is_empty() {
        return Ok(());
    }
    Err(format!(
        "{} in {ASSETS} is not what `web` builds; in `web`, run `npm run build` and commit",
        different.join(", ")
    ))
}

fn file_names(folder: &Path) -> Result<Vec<String>, String> {
    let failed = |error| format!("cannot read {}: {error}", folder.display());
    fs::read_dir(folder)
        .map_err(failed)?
        .map(|entry| {
            Ok(entry
                .map_err(failed)?
                .file_name()
                .to_string_lossy()
                .into_owned())
        })
        .collect()
}

fn test_files(web: &Path) -> Result<Vec<String>, String> {
    let mut files: Vec<String> = file_names(&web.join("tests"))?
        .into_iter()
        .filter(|name| name.ends_with(".test.mjs"))
        .map(|name| format!("tests/{name}"))
        .collect();
    files.sort();
    Ok(files)
}

/// The browser; as root on a Debian system it is installed where it is missing.
fn browser() -> Result<PathBuf, String> {
    if let Some(named) = env::var_os("CATENIX_CHROMIUM") {
        return Ok(PathBuf::from(named));
    }
    if let Some(found) = find_browser() {
        return Ok(found);
    }
    let is_root = Command::new("id")
        .arg("-u")
        .output()
        .is_ok_and(|output| output.stdout.starts_with(b"0\n"));
    if is_root && find_program("apt-get").is_some() {
        run_command(Command::new("apt-get").args(["update", "-qq"]))?;
        let arguments = [
            "install",
            "-qq",
            "-y",
            "--no-install-recommends",
            "chromium",
        ];
        run_command(Command::new("apt-get").args(arguments))?;
    }
    find_browser().ok_or_else(|| {
        "the step needs Chromium (Debian and Ubuntu: apt-get install chromium), or the path of one \
         in CATENIX_CHROMIUM"
            .to_owned()
    })
}

fn find_browser() -> Option<PathBuf> {
    BROWSERS.into_iter().find_map(find_program)
}

fn find_program(name: &str) -> Option<PathBuf> {
    let file = format!("{name}{}", env::consts::EXE_SUFFIX);
    env::split_paths(&env::var_os("PATH")?)
        .map(|folder| folder.join(&file))
        .find(|path| path.is_file())
}

fn node(web: &Path) -> Command {
    let mut command = Command::new("node");
    command.current_dir(web);
    command
}

fn npm(web: &Path) -> Command {
    let mut command = Command::new(if cfg!(windows) { "npm.cmd" } else { "npm" });
    command.current_dir(web);
    command
}

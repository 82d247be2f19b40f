//! `catenix view`, and the viewer of `catenix run --live`.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use catenix_viewer::{Listen, Viewer};

use crate::args::{ListenArgs, ViewArgs};
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::print;

/// How often Ctrl-C is looked for.
const LOOK: Duration = Duration::from_millis(100);

pub(crate) fn view(args: &ViewArgs) -> Result<Exit, Failure> {
    let interrupt = Interrupt::listen()?;
    start(&args.results, &args.listen)?;
    wait(&interrupt);
    Ok(Exit::Success)
}

/// Starts a viewer of the store, says where it is, and opens it in the browser.
pub(super) fn start(results: &Path, args: &ListenArgs) -> Result<(), Failure> {
    let viewer = Viewer::bind(results, listen(args))?;
    let url = viewer.url();
    viewer.spawn();
    print::error(&format!("viewer: {url}  (Ctrl-C ends it)"));
    if args.address.is_some_and(|address| !address.is_loopback()) {
        print::error("viewer: other machines can reach it; the link is the only key, unencrypted");
    }
    if !args.no_open {
        open_browser(&url);
    }
    Ok(())
}

/// Waits until the user ends the viewer.
pub(super) fn wait(interrupt: &Interrupt) {
    interrupt.computing_is_over();
    while !interrupt.requested() {
        std::thread::sleep(LOOK);
    }
}

fn listen(args: &ListenArgs) -> Listen {
    let usual = Listen::default();
    Listen {
        address: args.address.unwrap_or(usual.address),
        port: args.port.unwrap_or(usual.port),
    }
}

/// Asks the desktop to open the page. Without a desktop the printed link is all there is.
fn open_browser(url: &str) {
    let mut command = if cfg!(target_os = "macos") {
        Command::new("open")
    } else if cfg!(windows) {
        let mut command = Command::new("rundll32");
        command.arg("url.dll,FileProtocolHandler");
        command
    } else {
        Command::new("xdg-open")
    };
    let silent = command
        .arg(url)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    let _ = silent.spawn();
}

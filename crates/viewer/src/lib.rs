//! The viewer: a small web server that shows a result store in the browser, also while a run fills
//! it.
//!
//! [`Viewer::bind`] opens the store and a port, [`Viewer::spawn`] serves until the program ends. The
//! page is embedded; it fetches a description of the store and then single chunks, so that nothing
//! is ever loaded whole. Only files of the store are served, only under a random token, only to this
//! machine unless another address is asked for, and no request is longer than a few kilobytes.
//!
//! The server speaks the small part of HTTP/1.1 that a browser needs to read (`GET`, `HEAD`,
//! connections that are kept): a general server would bring a hundred crates for what fits in two
//! files, and its limits would be somebody else's.

mod assets;
mod connection;
mod error;
mod request;
mod response;
mod routes;
mod token;

use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use catenix_results::StoredStudy;

pub use error::ViewerError;

use crate::routes::Site;

/// Connections served at once; a browser opens six per page.
const MOST_CONNECTIONS: usize = 64;

/// Where to listen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Listen {
    /// Address; anything but loopback lets other machines in, with the token as the only key.
    pub address: IpAddr,
    /// Port; 0 takes any that is free.
    pub port: u16,
}

impl Default for Listen {
    fn default() -> Self {
        Listen {
            address: IpAddr::V4(Ipv4Addr::LOCALHOST),
            port: 0,
        }
    }
}

/// A viewer that holds its port and is ready to serve.
#[derive(Debug)]
pub struct Viewer {
    listener: TcpListener,
    local: SocketAddr,
    site: Arc<Site>,
}

impl Viewer {
    /// Checks the store at `results` (a `results.zarr` or the directory that holds one) and takes
    /// the port.
    pub fn bind(results: &Path, listen: Listen) -> Result<Viewer, ViewerError> {
        let study = StoredStudy::open(results)?;
        if study.case_names().is_empty() {
            return Err(ViewerError::Empty {
                path: study.path().to_path_buf(),
            });
        }
        let address = SocketAddr::new(listen.address, listen.port);
        let listener =
            TcpListener::bind(address).map_err(|source| ViewerError::listening(address, source))?;
        let local = listener
            .local_addr()
            .map_err(|source| ViewerError::listening(address, source))?;
        let site = Site::new(study.path(), token::random()?, local.ip().is_loopback())?;
        Ok(Viewer {
            listener,
            local,
            site: Arc::new(site),
        })
    }

    /// Address of the page, token included.
    pub fn url(&self) -> String {
        // An unspecified address is no place to go to; the server listens on loopback too.
        let host = if self.local.ip().is_unspecified() {
            IpAddr::V4(Ipv4Addr::LOCALHOST)
        } else {
            self.local.ip()
        };
        let place = SocketAddr::new(host, self.local.port());
        format!("http://{place}/{}/", self.site.token())
    }

    /// Serves on threads of its own until the program ends.
    pub fn spawn(self) {
        thread::spawn(move || self.accept());
    }

    fn accept(&self) {
        let open = Arc::new(AtomicUsize::new(0));
        for stream in self.listener.incoming() {
            // A connection that broke before it began is nobody's trouble.
            let Ok(stream) = stream else {
                continue;
            };
            if open.fetch_add(1, Ordering::SeqCst) >= MOST_CONNECTIONS {
                open.fetch_sub(1, Ordering::SeqCst);
                connection::refuse(stream);
                continue;
            }
            let (site, open) = (Arc::clone(&self.site), Arc::clone(&open));
            thread::spawn(move || {
                let _guard = Guard(open);
                connection::serve(stream, &site);
            });
        }
    }
}

/// Counts a connection out, also when its thread panics.
struct Guard(Arc<AtomicUsize>);

impl Drop for Guard {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::SeqCst);
    }
}

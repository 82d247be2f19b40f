//! Why a viewer does not start.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

use catenix_results::StoreError;

/// An error that keeps a viewer from starting.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewerError {
    /// There is no store, or not one that this version reads.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The store holds no load case.
    #[error("{path} holds no load case: there is nothing to view; run the model again")]
    Empty {
        /// The store.
        path: PathBuf,
    },
    /// Another program listens on the port.
    #[error(
        "port {} is in use by another program; choose another with --port, or leave --port out to \
         take any that is free",
        .address.port()
    )]
    PortInUse {
        /// Address and port.
        address: SocketAddr,
    },
    /// The operating system does not let the viewer listen.
    #[error("cannot listen on {address}: {source}")]
    Listen {
        /// Address and port.
        address: SocketAddr,
        /// What the operating system says.
        source: io::Error,
    },
    /// The operating system has no random numbers for the token.
    #[error("cannot make a random token: {message}")]
    Random {
        /// What the operating system says.
        message: String,
    },
}

impl ViewerError {
    pub(crate) fn listening(address: SocketAddr, source: io::Error) -> Self {
        if source.kind() == io::ErrorKind::AddrInUse {
            ViewerError::PortInUse { address }
        } else {
            ViewerError::Listen { address, source }
        }
    }

    /// Stable identifier for scripts, of the form `viewer::kind`.
    pub fn code(&self) -> &'static str {
        match self {
            ViewerError::Store(error) => error.code(),
            ViewerError::Empty { .. } => "viewer::empty",
            ViewerError::PortInUse { .. } => "viewer::port_in_use",
            ViewerError::Listen { .. } => "viewer::listen",
            ViewerError::Random { .. } => "viewer::random",
        }
    }
}

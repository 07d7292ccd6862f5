//! Errors of writing and reading files and of drawing, with the file or the picture that they concern.

use std::error::Error;
use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The reason why a file or a picture could not be made.
#[derive(Debug)]
#[non_exhaustive]
pub enum StudyError {
    /// A file or one of its parent folders could not be written.
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// A file could not be read, or is not what it should be.
    #[cfg(feature = "serde")]
    Read {
        /// The file.
        path: PathBuf,
        /// The error of the operating system or of the reader.
        source: Box<dyn Error + Send + Sync>,
    },
    /// A picture has no curve with a finite point, or a page no sample, or nothing that it shows.
    NothingToDraw {
        /// The picture's title.
        title: String,
    },
    /// A picture of this size has no room for its axes, or more pixels than a picture may have.
    Size {
        /// The picture's title.
        title: String,
        /// The width asked for, in pixels.
        width: u32,
        /// The height asked for, in pixels.
        height: u32,
    },
    /// A value that a page should show is not finite, or beyond `1e18`, or no orientation.
    NotDrawable {
        /// The page's title.
        title: String,
        /// The body, path or curve.
        what: String,
        /// The first time at which it is so.
        time: f64,
    },
    /// A page mentions a body that was not put on it.
    UnknownBody {
        /// The page's title.
        title: String,
        /// The name.
        name: String,
    },
    /// A page is to show a contact that the system does not have.
    UnknownContact {
        /// The page's title.
        title: String,
        /// The name.
        name: String,
        /// The names of the contacts, grips and latches.
        known: Vec<&'static str>,
    },
    /// A page does not fit the size that was asked for.
    TooLarge {
        /// The page's title.
        title: String,
        /// The bytes that it needs at least, as far as that is known.
        bytes: usize,
        /// The bytes that it may have.
        limit: usize,
    },
    /// A picture is to show an entry that the state does not have.
    UnknownEntry {
        /// The picture's title.
        title: String,
        /// The name.
        name: String,
        /// The names of the entries.
        known: &'static [&'static str],
    },
    /// The times of a recording neither rise nor fall throughout.
    Times {
        /// The page's title.
        title: String,
        /// The first time that is not finite, or not on the same side of the one before.
        time: f64,
    },
    /// The drawing library refused an element of a picture.
    Drawing {
        /// The picture's title.
        title: String,
        /// The error of the library.
        source: Box<dyn Error + Send + Sync>,
    },
}

impl fmt::Display for StudyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io { path, source } => write!(f, "cannot write `{}`: {source}", path.display()),
            #[cfg(feature = "serde")]
            Self::Read { path, source } => write!(f, "cannot read `{}`: {source}", path.display()),
            Self::NothingToDraw { title } => {
                write!(f, "picture `{title}` has nothing to draw: no sample, or no finite point")
            }
            Self::Size { title, width, height } => {
                write!(f, "picture `{title}` cannot be drawn with {width} by {height} pixels")
            }
            Self::NotDrawable { title, what, time } => {
                write!(f, "page `{title}`: `{what}` cannot be drawn at t = {time}")
            }
            Self::UnknownBody { title, name } => write!(f, "page `{title}` has no body `{name}`"),
            Self::UnknownContact { title, name, known } => {
                write!(f, "page `{title}`: the system has no contact `{name}`, it has {}", known.join(", "))
            }
            Self::TooLarge { title, bytes, limit } => {
                write!(
                    f,
                    "page `{title}` needs {bytes} bytes or more, but may have {limit}: show fewer samples or things, or allow more by `within_bytes`"
                )
            }
            Self::UnknownEntry { title, name, known } => {
                write!(f, "picture `{title}`: the state has no `{name}`")?;
                if known.is_empty() { Ok(()) } else { write!(f, ", but {}", known.join(", ")) }
            }
            Self::Times { title, time } => {
                write!(f, "page `{title}`: the times neither rise nor fall throughout, first at t = {time}")
            }
            Self::Drawing { title, source } => write!(f, "cannot draw picture `{title}`: {source}"),
        }
    }
}

impl Error for StudyError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            Self::Drawing { source, .. } => Some(&**source),
            #[cfg(feature = "serde")]
            Self::Read { source, .. } => Some(&**source),
            Self::NothingToDraw { .. }
            | Self::Size { .. }
            | Self::NotDrawable { .. }
            | Self::UnknownBody { .. }
            | Self::UnknownEntry { .. }
            | Self::TooLarge { .. }
            | Self::UnknownContact { .. }
            | Self::Times { .. } => None,
        }
    }
}

/// Creates the folders that `path` lies in.
pub(crate) fn create_parents(path: &Path) -> Result<(), StudyError> {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => {
            fs::create_dir_all(folder).map_err(|source| StudyError::Io { path: folder.to_path_buf(), source })
        }
        _ => Ok(()),
    }
}

/// Attaches the file that was being written.
pub(crate) fn at_path(path: &Path) -> impl FnOnce(io::Error) -> StudyError {
    let path = path.to_path_buf();
    move |source| StudyError::Io { path, source }
}

/// Attaches the file that was being read.
#[cfg(feature = "serde")]
pub(crate) fn from_path<E: Into<Box<dyn Error + Send + Sync>>>(path: &Path) -> impl FnOnce(E) -> StudyError {
    let path = path.to_path_buf();
    move |source| StudyError::Read { path, source: source.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_names_its_file() {
        let error = at_path(Path::new("target/x.csv"))(io::Error::other("disk full"));
        assert_eq!(error.to_string(), "cannot write `target/x.csv`: disk full");
        assert!(error.source().is_some());
    }
}

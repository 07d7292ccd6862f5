//! Files that are written whole or not at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::{StudyError, at_path, create_parents};

/// Writes a file whole or not at all: whoever reads it, after a failure, a kill or a power cut too, finds the old content or
/// the new one, never a part.
///
/// `write` writes to a temporary file in the same folder (`.guen-PROCESS-NUMBER.tmp`), which then takes the place of the
/// old file in one step. Parent folders are created. An error or a panic of `write` removes the temporary file and leaves
/// the old one as it was; a process that is killed can leave the temporary file behind.
///
/// All writers of this crate use it: [`Recording::save_csv`](crate::Recording::save_csv), [`Plot::save`](crate::Plot::save)
/// and the others. The new file has owner and permissions of the old one. A symbolic link is followed; of several hard links the
/// given one gets the new content. What is no regular file, such as a pipe or a path below `/dev`, is written directly.
///
/// ```
/// use guen_study::replace_file;
///
/// let path = std::env::temp_dir().join(format!("guen-docs-{}/notes.txt", std::process::id()));
/// replace_file(&path, |file| file.write_all(b"one\n"))?;
/// // A writer that fails halfway loses nothing.
/// let failed = replace_file(&path, |file| {
///     file.write_all(b"tw")?;
///     Err(std::io::Error::other("out of ideas"))
/// });
/// assert!(failed.is_err());
/// assert_eq!(std::fs::read_to_string(&path).unwrap(), "one\n");
/// # std::fs::remove_dir_all(path.parent().unwrap()).unwrap();
/// # Ok::<(), guen_study::StudyError>(())
/// ```
///
/// # Errors
///
/// [`StudyError::Io`] with the path: `write` failed, or the folder or the old file cannot be written.
pub fn replace_file(
    path: impl AsRef<Path>,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), StudyError> {
    let path = path.as_ref();
    create_parents(path)?;
    replace(path, write).map_err(at_path(path))
}

fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let old = match fs::metadata(path) {
        Ok(old) if !old.is_file() || is_device(path) => {
            let mut out = BufWriter::new(OpenOptions::new().write(true).open(path)?);
            write(&mut out)?;
            return out.flush();
        }
        Ok(old) => Some(old),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    let target = followed(path)?;
    if old.is_some() {
        // Who may not write the old file may not replace it either.
        OpenOptions::new().write(true).open(&target)?;
    }
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    };
    let (file, temporary) = Temporary::create(&folder)?;
    let mut out = BufWriter::new(file);
    write(&mut out)?;
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    if let Some(old) = old {
        #[cfg(unix)]
        {
            use std::os::unix::fs::{MetadataExt, fchown};
            // Only the administrator writes files of others, and may be forbidden to give them away.
            let _ = fchown(&file, Some(old.uid()), Some(old.gid()));
        }
        file.set_permissions(old.permissions())?;
    }
    // The content has to be on the disk before the name is, or a power cut would leave an empty file by that name.
    file.sync_all()?;
    drop(file);
    temporary.rename(&target)?;
    // The new name as well, where folders can be synchronised; the content is whole either way.
    if let Ok(folder) = File::open(&folder) {
        let _ = folder.sync_all();
    }
    Ok(())
}

/// Devices, and the open files of a process, have a name but no content of their own.
fn is_device(path: &Path) -> bool {
    path.starts_with("/dev") || path.starts_with("/proc")
}

/// The most links that are followed one after another.
const MOST_LINKS: usize = 40;

/// The path behind symbolic links, of which the last may lead to a file that is not there yet.
fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(next) => path = path.parent().unwrap_or(Path::new("")).join(next),
            // Not a link, or nothing at all.
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many symbolic links"))
}

/// A temporary file, which is removed unless it is renamed.
struct Temporary(Option<PathBuf>);

impl Temporary {
    /// A new file in a folder, by a name that no file there has.
    fn create(folder: &Path) -> io::Result<(File, Self)> {
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        loop {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let path = folder.join(format!(".guen-{}-{number}.tmp", process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok((file, Self(Some(path)))),
                // Left by a process with the same number, which was killed.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    fn rename(mut self, target: &Path) -> io::Result<()> {
        if let Some(path) = &self.0 {
            fs::rename(path, target)?;
        }
        self.0 = None;
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(path) = &self.0 {
            let _ = fs::remove_file(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of its own, removed at the end.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("guen-study-{name}-{}", process::id()));
            let _ = fs::remove_dir_all(&path);
            fs::create_dir_all(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            Self(path)
        }

        fn names(&self) -> Vec<String> {
            let entries = fs::read_dir(&self.0).unwrap();
            let mut names: Vec<String> =
                entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
            names.sort();
            names
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            fs::remove_dir_all(&self.0).unwrap();
        }
    }

    #[test]
    fn failures_and_panics_leave_the_old_file_and_nothing_else() {
        let folder = Folder::new("failures");
        let path = folder.0.join("run.csv");
        replace_file(&path, |out| out.write_all(b"old")).unwrap();
        let failed = replace_file(&path, |out| {
            out.write_all(&[b'x'; 100_000])?;
            Err(io::Error::other("disk full"))
        });
        assert!(matches!(&failed, Err(StudyError::Io { path: at, .. }) if *at == path), "{failed:?}");
        let panicked = std::panic::catch_unwind(|| {
            replace_file(&path, |out| {
                out.write_all(&[b'x'; 100_000])?;
                panic!("halfway")
            })
        });
        assert!(panicked.is_err(), "{panicked:?}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(folder.names(), ["run.csv"]);
        // A folder is no file, and stays.
        assert!(matches!(replace_file(&folder.0, |_| Ok(())), Err(StudyError::Io { .. })));
        assert_eq!(folder.names(), ["run.csv"]);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = Folder::new("links");
        fs::create_dir(folder.0.join("data")).unwrap();
        let (file, link) = (folder.0.join("data/run.csv"), folder.0.join("newest.csv"));
        symlink("data/run.csv", &link).unwrap();
        // A link that leads nowhere yet, then one to a file.
        for text in ["one", "two"] {
            replace_file(&link, |out| out.write_all(text.as_bytes())).unwrap();
            assert_eq!(fs::read_to_string(&file).unwrap(), text);
            assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
            fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        }
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
        let around = folder.0.join("around");
        symlink("around", &around).unwrap();
        assert!(replace_file(&around, |_| Ok(())).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_written_directly() {
        replace_file("/dev/null", |out| out.write_all(b"nothing")).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}

//! The folder of a sweep: its manifest, locks, rows and records, each file whole or not there.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::block::Block;
use super::error::{MANIFEST, SweepError, at};
use super::plan::{DECLARATION, Plan};
use super::record::Record;
use super::rows::Rows;
use super::sha256::Sha256;
use crate::file::replace_file;

/// The line of the manifest that says how many parts there are.
const PARTS: &str = "parts: ";
/// The names of files that locks are taken on: of the folder, and of the workers that compute chunks there for another process.
const LOCK: &str = ".sweep.lock";
const WORKERS: &str = ".workers.lock";

/// The file of the record of a part.
pub(super) fn record_file(part: u64, parts: u64) -> String {
    format!("part-{part}-of-{parts}.txt")
}

/// The rows of a folder.
#[derive(Clone, Debug)]
pub(super) struct RowsFolder {
    path: PathBuf,
    rows: Rows,
}

/// The folder while one process is at work on a part there.
#[derive(Debug)]
pub(super) struct PartFolder {
    pub(super) rows: RowsFolder,
    part: u64,
    parts: u64,
    /// Unlocked by the operating system when it is closed, however the process ends.
    _lock: Option<File>,
}

/// Opens a file to take a lock on.
fn lock_file(path: &Path) -> Result<File, SweepError> {
    OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(at(path))
}

/// Takes the lock of a file for one process alone.
fn locked(path: &Path, busy: impl Fn() -> SweepError) -> Result<File, SweepError> {
    let file = lock_file(path)?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(busy()),
        Err(TryLockError::Error(error)) => Err(at(path)(error)),
    }
}

/// The number of parts that a manifest tells, if it is that of this sweep.
pub(super) fn parts_of(path: &Path, text: &str, plan: &Plan) -> Result<u64, SweepError> {
    let (content, parts) = text
        .rsplit_once(PARTS)
        .ok_or_else(|| SweepError::Corrupt { path: path.to_path_buf(), reason: "its end is missing" })?;
    if content != plan.text {
        let mut lines = content.lines();
        let other = plan.text.lines().find_map(|expected| {
            let found = lines.next().unwrap_or_default();
            (found != expected).then(|| (found.to_owned(), expected.to_owned()))
        });
        let (found, expected) = other.ok_or_else(|| SweepError::Corrupt {
            path: path.to_path_buf(),
            reason: "its lines end otherwise, or there are others behind them",
        })?;
        let digest = |line: &str| Some(line.strip_prefix(DECLARATION)?.strip_prefix(": ")?.to_owned());
        if let (Some(found), Some(expected)) = (digest(&found), digest(&expected)) {
            return Err(SweepError::OtherDeclaration { path: path.to_path_buf(), found, expected });
        }
        return Err(SweepError::OtherSweep { path: path.to_path_buf(), found, expected });
    }
    parts.trim_end().parse().map_err(|_| SweepError::Corrupt {
        path: path.to_path_buf(),
        reason: "the number of its parts is none",
    })
}

/// Writes the manifest.
pub(super) fn write_manifest(folder: &Path, plan: &Plan, parts: u64) -> Result<(), SweepError> {
    let text = format!("{}{PARTS}{parts}\n", plan.text);
    Ok(replace_file(folder.join(MANIFEST), |out| out.write_all(text.as_bytes()))?)
}

/// The content of a file, or none if there is no such file.
pub(super) fn content(path: &Path) -> Result<Option<Vec<u8>>, SweepError> {
    match fs::read(path) {
        Ok(content) => Ok(Some(content)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(at(path)(error)),
    }
}

impl PartFolder {
    /// Makes the folder, if it is not there, and takes it for a part.
    pub(super) fn open(
        path: &Path,
        plan: &Plan,
        (part, parts): (u64, u64),
        rows: Rows,
        locks: bool,
    ) -> Result<Self, SweepError> {
        let below = path.join("rows");
        fs::create_dir_all(&below).map_err(at(&below))?;
        {
            // Only one process at a time looks for the manifest and writes it.
            let lock = path.join(LOCK);
            let file = if locks { Some(lock_file(&lock)?) } else { None };
            if let Some(file) = &file {
                file.lock().map_err(at(&lock))?;
            }
            let manifest = path.join(MANIFEST);
            match content(&manifest)? {
                Some(text) => {
                    let found = parts_of(&manifest, &String::from_utf8_lossy(&text), plan)?;
                    if found != parts {
                        return Err(SweepError::OtherParts { path: manifest, found, asked: parts });
                    }
                }
                None => write_manifest(path, plan, parts)?,
            }
        }
        let busy = || SweepError::Busy { path: path.to_path_buf(), part, parts };
        let lock = if locks {
            let name = path.join(format!(".part-{part}-of-{parts}.lock"));
            Some(locked(&name, busy)?)
        } else {
            None
        };
        // Workers that have outlived their coordinator may still write rows.
        let workers = path.join(WORKERS);
        if locks && workers.exists() {
            locked(&workers, busy)?;
        }
        Ok(Self { rows: RowsFolder { path: path.to_path_buf(), rows }, part, parts, _lock: lock })
    }

    /// The record of this part. A record that is damaged counts as none: its chunks are computed anew.
    pub(super) fn record(&self, plan: &Plan) -> Result<(Record, bool), SweepError> {
        let path = self.rows.path.join(record_file(self.part, self.parts));
        let Some(text) = content(&path)? else { return Ok((Record::new(plan), false)) };
        let read = std::str::from_utf8(&text).map_err(|_| "").and_then(|text| Record::parse(plan, text));
        Ok(read.map_or_else(|_| (Record::new(plan), true), |record| (record, false)))
    }

    /// The chunks of the record whose files are not there, or are damaged.
    pub(super) fn lost(&self, record: &Record) -> Result<Vec<u64>, SweepError> {
        let mut lost = Vec::new();
        for (number, chunk) in &record.chunks {
            let (Some(name), Some(digest)) = (self.rows.rows.file(*number), &chunk.file) else { continue };
            let found = content(&self.rows.path.join(name))?;
            if found.is_none_or(|found| Sha256::of(&found) != *digest) {
                lost.push(*number);
            }
        }
        Ok(lost)
    }

    pub(super) fn write_record(&self, record: &Record, plan: &Plan) -> Result<(), SweepError> {
        let text = record.text(plan);
        let path = self.rows.path.join(record_file(self.part, self.parts));
        Ok(replace_file(path, |out| out.write_all(text.as_bytes()))?)
    }
}

impl RowsFolder {
    /// Takes a folder that a coordinator has made, for a worker: with the lock that tells that it is at work.
    pub(super) fn of_worker(
        path: &Path,
        plan: &Plan,
        rows: Rows,
        locks: bool,
    ) -> Result<(Self, Option<File>), SweepError> {
        let manifest = path.join(MANIFEST);
        let text = fs::read(&manifest).map_err(at(&manifest))?;
        let found = parts_of(&manifest, &String::from_utf8_lossy(&text), plan)?;
        if found != 1 {
            return Err(SweepError::OtherParts { path: manifest, found, asked: 1 });
        }
        let lock = if locks {
            let name = path.join(WORKERS);
            let file = lock_file(&name)?;
            // Any number of workers has it at a time.
            file.lock_shared().map_err(at(&name))?;
            Some(file)
        } else {
            None
        };
        Ok((Self { path: path.to_path_buf(), rows }, lock))
    }

    /// Writes the rows of a chunk, and returns the digest of the file. The disk is not waited for: the record has the digest, so that a
    /// file which a power cut has torn is found and written anew.
    pub(super) fn write_rows(
        &self,
        plan: &Plan,
        chunk: u64,
        block: &Block,
    ) -> Result<Option<String>, SweepError> {
        let Some(name) = self.rows.file(chunk) else { return Ok(None) };
        let content = self.rows.content(plan, block)?;
        let path: PathBuf = self.path.join(name);
        // The name is always the same, so that a kill leaves nothing that the next run does not write over.
        let temporary = path.with_extension("unfinished");
        let written = File::create(&temporary)
            .and_then(|mut file| file.write_all(&content))
            .and_then(|()| fs::rename(&temporary, &path));
        if let Err(error) = written {
            let _ = fs::remove_file(&temporary);
            return Err(at(&path)(error));
        }
        Ok(Some(Sha256::of(&content)))
    }
}

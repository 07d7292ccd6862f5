//! The folder of a sweep: its manifest, locks, rows and records, each file whole or not there.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::block::Block;
use super::error::{SweepError, at};
use super::plan::{DECLARATION, Plan};
use super::record::Record;
use super::rows::Rows;
use super::sha256::Sha256;
use crate::file::replace_file;

/// The manifest.
pub(super) const MANIFEST: &str = "sweep.txt";
/// The line of the manifest that says how many parts there are.
const PARTS: &str = "parts: ";
/// The name of files that locks are taken on.
const LOCK: &str = ".sweep.lock";

/// The file of the record of a part.
pub(super) fn record_file(part: u64, parts: u64) -> String {
    format!("part-{part}-of-{parts}.txt")
}

/// The folder while one process is at work on a part there.
pub(super) struct PartFolder<'a> {
    pub(super) path: &'a Path,
    part: u64,
    parts: u64,
    rows: Rows,
    /// Unlocked by the operating system when it is closed, however the process ends.
    _lock: Option<File>,
}

/// Opens a file to take a lock on.
fn lock_file(path: &Path) -> Result<File, SweepError> {
    OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(at(path))
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
        let (found, expected) = other.unwrap_or_default();
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

impl<'a> PartFolder<'a> {
    /// Makes the folder, if it is not there, and takes it for a part.
    pub(super) fn open(
        path: &'a Path,
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
        let lock = if locks {
            let name = path.join(format!(".part-{part}-of-{parts}.lock"));
            let file = lock_file(&name)?;
            match file.try_lock() {
                Ok(()) => Some(file),
                Err(TryLockError::WouldBlock) => {
                    return Err(SweepError::Busy { path: path.to_path_buf(), part, parts });
                }
                Err(TryLockError::Error(error)) => return Err(at(&name)(error)),
            }
        } else {
            None
        };
        Ok(Self { path, part, parts, rows, _lock: lock })
    }

    /// The record of this part. A record that is damaged counts as none: its chunks are computed anew.
    pub(super) fn record(&self, plan: &Plan) -> Result<(Record, bool), SweepError> {
        let path = self.path.join(record_file(self.part, self.parts));
        let Some(text) = content(&path)? else { return Ok((Record::new(plan), false)) };
        let read = std::str::from_utf8(&text).map_err(|_| "").and_then(|text| Record::parse(plan, text));
        Ok(read.map_or_else(|_| (Record::new(plan), true), |record| (record, false)))
    }

    /// The chunks of the record whose files are not there, or are damaged.
    pub(super) fn lost(&self, record: &Record) -> Result<Vec<u64>, SweepError> {
        let mut lost = Vec::new();
        for (number, chunk) in &record.chunks {
            let (Some(name), Some(digest)) = (self.rows.file(*number), &chunk.file) else { continue };
            let found = content(&self.path.join(name))?;
            if found.is_none_or(|found| Sha256::of(&found) != *digest) {
                lost.push(*number);
            }
        }
        Ok(lost)
    }

    pub(super) fn write_record(&self, record: &Record, plan: &Plan) -> Result<(), SweepError> {
        let text = record.text(plan);
        let path = self.path.join(record_file(self.part, self.parts));
        Ok(replace_file(path, |out| out.write_all(text.as_bytes()))?)
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

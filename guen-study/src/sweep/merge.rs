//! Parts put together, in the files that one part alone would have written.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::Sweep;
use super::error::{MANIFEST, SweepError, at};
use super::folder::{content, parts_of, record_file, write_manifest};
use super::plan::Plan;
use super::record::Record;
use super::sha256::Sha256;
use super::summary::Summary;
use super::tables;
use crate::file::replace_file;

pub(super) fn merge(sweep: &Sweep<'_>, folders: Vec<PathBuf>, into: &Path) -> Result<Summary, SweepError> {
    let plan = Plan::of(sweep)?;
    let mut whole = Record::new(&plan);
    let mut places: BTreeMap<u64, PathBuf> = BTreeMap::new();
    let mut seen: Vec<PathBuf> = Vec::new();
    for folder in &folders {
        let folder = fs::canonicalize(folder).map_err(at(folder))?;
        if seen.contains(&folder) {
            continue;
        }
        let manifest = folder.join(MANIFEST);
        let text = fs::read(&manifest).map_err(at(&manifest))?;
        let parts = parts_of(&manifest, &String::from_utf8_lossy(&text), &plan)?;
        for path in records(&folder, parts)? {
            let Some(text) = content(&path)? else { continue };
            let damaged = |reason| SweepError::Corrupt { path: path.clone(), reason };
            let text = String::from_utf8(text).map_err(|_| damaged("it is no text"))?;
            let record = Record::parse(&plan, &text).map_err(damaged)?;
            for (number, chunk) in record.chunks {
                if whole.chunks.insert(number, chunk).is_some() {
                    return Err(SweepError::Overlap { first: plan.motions(number).start });
                }
                places.insert(number, folder.clone());
            }
            whole.statistics.merge(&record.statistics);
        }
        seen.push(folder);
    }
    let missing: Vec<u64> = (0..plan.chunks()).filter(|number| !whole.chunks.contains_key(number)).collect();
    if let Some(first) = missing.first() {
        let motions = missing.iter().map(|number| plan.motions(*number)).map(|range| range.end - range.start);
        return Err(SweepError::Unfinished { first: plan.motions(*first).start, missing: motions.sum() });
    }
    let rows = into.join("rows");
    fs::create_dir_all(&rows).map_err(at(&rows))?;
    let into = &fs::canonicalize(into).map_err(at(into))?;
    // A folder with something else in it stays as it is.
    let manifest = into.join(MANIFEST);
    let parts = match content(&manifest)? {
        Some(text) => parts_of(&manifest, &String::from_utf8_lossy(&text), &plan)?,
        None => {
            write_manifest(into, &plan, 1)?;
            1
        }
    };
    let mut digests = Vec::new();
    for (number, chunk) in &whole.chunks {
        let (Some(name), Some(digest), Some(from)) =
            (sweep.rows.file(*number), &chunk.file, places.get(number))
        else {
            continue;
        };
        copy_checked(from, into, &name, digest)?;
        digests.push((digest.clone(), name));
    }
    if parts == 1 {
        let (name, text) = (record_file(0, 1), whole.text(&plan));
        digests.push((Sha256::of(text.as_bytes()), name.clone()));
        replace_file(into.join(name), |out| out.write_all(text.as_bytes()))?;
    }
    for (name, text) in tables::all(&plan, &whole.statistics) {
        replace_file(into.join(&name), |out| out.write_all(text.as_bytes()))?;
        digests.push((Sha256::of(text.as_bytes()), name));
    }
    let sums: String = digests.iter().map(|(digest, name)| format!("{digest}  {name}\n")).collect();
    replace_file(into.join("SHA256SUMS"), |out| out.write_all(sums.as_bytes()))?;
    Ok(Summary::new(whole))
}

/// The records that a folder has of so many parts, in order. There may be more parts than could be looked for one by one.
fn records(folder: &Path, parts: u64) -> Result<Vec<PathBuf>, SweepError> {
    let end = format!("-of-{parts}.txt");
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(at(folder))? {
        let name = entry.map_err(at(folder))?.file_name();
        let number =
            name.to_str().and_then(|name| name.strip_prefix("part-")?.strip_suffix(&end)?.parse().ok());
        found.extend(number.filter(|part: &u64| *part < parts));
    }
    found.sort_unstable();
    Ok(found.into_iter().map(|part| folder.join(record_file(part, parts))).collect())
}

/// Looks whether a file has its digest, and copies it unless it is there.
fn copy_checked(from: &Path, into: &Path, name: &str, digest: &str) -> Result<(), SweepError> {
    let (source, target) = (from.join(name), into.join(name));
    let bytes = fs::read(&source).map_err(at(&source))?;
    if Sha256::of(&bytes) != digest {
        return Err(SweepError::Corrupt {
            path: source,
            reason: "its content does not fit the digest in the record",
        });
    }
    if from == into {
        return Ok(());
    }
    Ok(replace_file(target, |out| out.write_all(&bytes))?)
}

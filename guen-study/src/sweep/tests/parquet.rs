//! Metadata of files of Parquet: the sweep and the declaration that they belong to.

use std::collections::BTreeMap;
use std::fs::File;

use ::parquet::file::reader::{FileReader, SerializedFileReader};

use super::*;

/// The keys and values that every file of rows has in its metadata.
fn metadata(folder: &Path) -> Vec<BTreeMap<String, String>> {
    let names = files(folder).into_iter().map(|(name, _)| name);
    let of_file = |name: String| {
        let reader = SerializedFileReader::new(File::open(folder.join(name)).unwrap()).unwrap();
        let pairs = reader.metadata().file_metadata().key_value_metadata().unwrap();
        pairs.iter().map(|pair| (pair.key.clone(), pair.value.clone().unwrap())).collect()
    };
    names.filter(|name| name.starts_with("rows/")).map(of_file).collect()
}

#[test]
fn every_file_tells_its_sweep_and_declaration() {
    let folder = Folder::new("parquet");
    for (name, sweep, expected) in [
        ("other", declared::<0xfedc_ba98_7654_3210>(), "fedcba9876543210"),
        ("declared", declared::<0x2a>(), "000000000000002a"),
        ("none", ends(60), "none"),
    ] {
        let place = folder.below(name);
        sweep.with_rows(Rows::Parquet).run_in(&place).unwrap();
        let manifest = std::fs::read_to_string(place.join("sweep.txt")).unwrap();
        let all = metadata(&place);
        assert!(all.len() > 1, "{name}");
        for of_file in all {
            assert_eq!(of_file["guen.declaration"], expected);
            assert!(manifest.contains(&format!("declaration: {}\n", of_file["guen.declaration"])));
            assert_eq!(manifest.strip_prefix(&of_file["guen.sweep"]), Some("parts: 1\n"));
            assert_eq!(
                of_file["guen.digest"],
                crate::sweep::sha256::Sha256::of(of_file["guen.sweep"].as_bytes())
            );
            assert_eq!(of_file["guen.unit.q"], "rad");
        }
    }
}

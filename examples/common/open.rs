//! Shows a page to whoever sits at a desktop.

use std::env;
use std::path::Path;
use std::process::Command;

/// Opens a file with the program that the desktop has for it; where there is no desktop, or it refuses, says so.
pub fn open(file: &Path) {
    // On Windows the status of `explorer` says nothing.
    let (opener, desktop, sure) = match env::consts::OS {
        "macos" => ("open", true, true),
        "windows" => ("explorer", true, false),
        _ => {
            let screens = ["DISPLAY", "WAYLAND_DISPLAY"];
            ("xdg-open", screens.iter().any(|name| env::var_os(name).is_some()), true)
        }
    };
    let refused = match desktop.then(|| Command::new(opener).arg(file).status()) {
        Some(Ok(status)) if status.success() || !sure => return,
        Some(Ok(status)) => format!("`{opener}` ended with {status}"),
        Some(Err(error)) => format!("`{opener}`: {error}"),
        None => "there is no desktop here".to_owned(),
    };
    eprintln!("not opened, {refused}: open {} in a browser", file.display());
}

//! The digest of a declaration, by which a study finds that it was begun with another one.

use std::fmt::{self, Write};

use super::{Declaration, Item, Scene};

impl Declaration {
    /// The digest of the text that motions of the system, or of one of its scenes, follow from: as it is printed, so without documentation,
    /// comments and layout, without what is provided, and without the other scenes. By the FNV-1a hash of 64 bits: the question is whether
    /// somebody has edited the text, not whether somebody forges it.
    pub fn digest(&self, scene: Option<&Scene>) -> u64 {
        let mut hash = Fnv(Fnv::BASIS);
        // Neither the hash nor what is printed fails.
        let _ = self.write_followed(scene, &mut hash);
        hash.0
    }

    fn write_followed(&self, scene: Option<&Scene>, out: &mut Fnv) -> fmt::Result {
        writeln!(out, "system {}", self.name.ident)?;
        let items = self.items.iter().filter(|item| !matches!(item, Item::Scene(_) | Item::Provide(_)));
        items.into_iter().try_for_each(|item| writeln!(out, "{item}"))?;
        scene.map_or(Ok(()), |scene| writeln!(out, "{scene}"))
    }
}

/// Returns the digest of a text: the same for the same text, everywhere.
pub fn digest_of(text: &str) -> u64 {
    let mut hash = Fnv(Fnv::BASIS);
    // The hash does not fail.
    let _ = hash.write_str(text);
    hash.0
}

/// The hash FNV-1a of 64 bits. Source: G. Fowler, L. C. Noll, K.-P. Vo, D. Eastlake, *The FNV Non-Cryptographic Hash Algorithm*.
struct Fnv(u64);

impl Fnv {
    const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0100_0000_01b3;
}

impl Write for Fnv {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(Self::PRIME);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digest(text: &str, scene: Option<&str>) -> u64 {
        let (declaration, report) = crate::parse::parse(text.parse().unwrap());
        assert!(report.is_empty());
        let declaration = declaration.unwrap();
        let own = declaration.items.iter().find_map(|item| match item {
            Item::Scene(own) if Some(own.name.text.as_str()) == scene => Some(own),
            _ => None,
        });
        assert_eq!(own.is_some(), scene.is_some());
        declaration.digest(own)
    }

    const PENDULUM: &str = "system P { constants { l > 0, g = 9.81 } coordinates { phi } parameters { w = dot(phi); }
        kinetic_energy = l^2*w^2/2; potential_energy = -g*l*cos(phi); scene Fixed { fix l = 1; } scene Other { fix l = 2; } }";

    #[test]
    fn the_hash_is_that_of_its_authors() {
        let mut hash = Fnv(Fnv::BASIS);
        hash.write_str("foobar").unwrap();
        assert_eq!(hash.0, 0x8594_4171_f739_67e8);
    }

    #[test]
    fn a_digest_tells_motions_apart_and_nothing_else() {
        let own = digest(PENDULUM, None);
        for same in [
            PENDULUM.replace(" = ", "="),
            PENDULUM.replace("system P", "/// Swings.\npub system P"),
            PENDULUM.replace("scene Other { fix l = 2; }", "scene Another { fix l = 3; }"),
            PENDULUM.replace("scene Fixed", "provide source; scene Fixed"),
        ] {
            assert_eq!(digest(&same, None), own, "{same}");
        }
        for other in [
            PENDULUM.replace("9.81", "9.80665"),
            PENDULUM.replace("l^2", "l^3"),
            PENDULUM.replace("-g*l", "g*l"),
            PENDULUM.replace("l > 0", "l >= 0"),
            PENDULUM.replace("phi", "psi"),
            PENDULUM.replace("system P", "system Q"),
        ] {
            assert_ne!(digest(&other, None), own, "{other}");
        }
        let fixed = digest(PENDULUM, Some("Fixed"));
        assert!(fixed != own && fixed != digest(PENDULUM, Some("Other")));
        assert_eq!(fixed, digest(&PENDULUM.replace("l = 2", "l = 3"), Some("Fixed")));
        assert_ne!(fixed, digest(&PENDULUM.replace("l = 1", "l = 3"), Some("Fixed")));
    }
}

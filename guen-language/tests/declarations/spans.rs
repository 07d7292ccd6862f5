//! Where the tokens of an expansion come from: names that a user wrote keep the places where they were written, so
//! that an editor leads from a field to its declaration, and from a use to the declaration.

use std::collections::BTreeMap;

use guen_language::expand;
use proc_macro2::{TokenStream, TokenTree};

const TEXT: &str = "pub system Sled {
    constants { mass > 0, reach }
    coordinates { phi, x, y }
    parameters { turning = dot(phi); speed = dot(x)*cos(phi) + dot(y)*sin(phi); }
    constraints { blade: dot(x)*sin(phi) = dot(y)*cos(phi); }
    let ahead = x + reach*cos(phi);
    kinetic_energy = mass/2*(dot(ahead)^2 + dot(y)^2 + turning^2);
    outputs { place = vec(ahead, y); }
}";

type LineAndColumn = (usize, usize);

/// The places at which each identifier of a stream was written.
fn identifiers(stream: TokenStream, found: &mut BTreeMap<String, Vec<LineAndColumn>>) {
    for token in stream {
        match token {
            TokenTree::Ident(ident) => {
                let start = ident.span().start();
                found.entry(ident.to_string()).or_default().push((start.line, start.column));
            }
            TokenTree::Group(group) => identifiers(group.stream(), found),
            _ => {}
        }
    }
}

#[test]
fn names_keep_their_places() {
    let (mut written, mut expanded) = (BTreeMap::new(), BTreeMap::new());
    identifiers(TEXT.parse().unwrap(), &mut written);
    identifiers(expand(TEXT.parse().unwrap()), &mut expanded);
    for name in ["Sled", "mass", "reach", "phi", "x", "y", "turning", "speed", "blade", "ahead", "place"] {
        for place in &written[name] {
            assert!(expanded[name].contains(place), "`{name}` at {place:?} leads nowhere");
        }
    }
}

#[test]
fn the_same_tokens_give_the_same_tokens() {
    let expansion = || expand(TEXT.parse().unwrap()).to_string();
    assert_eq!(expansion(), expansion());
}

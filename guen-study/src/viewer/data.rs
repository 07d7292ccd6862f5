//! Numbers and texts in the form in which the page reads them: JSON with samples as base64 of little-endian `f32`, and of `f64`
//! for times. Long samples stand beside the JSON, in parts that no string of a browser is too short for.

use std::fmt::Write;

/// JSON that is written from front to back.
#[derive(Default)]
pub(super) struct Json {
    text: String,
    /// Long samples, as base64, by their numbers in the JSON.
    parts: Vec<String>,
}

/// Bytes from which on samples stand beside the JSON.
const SEPARATE_BYTES: usize = 3 << 20;

/// Bytes of a part, a multiple of three.
const PART_BYTES: usize = 3 << 24;

impl Json {
    /// The JSON, and the parts that its long samples refer to.
    pub(super) fn into_texts(self) -> (String, Vec<String>) {
        (self.text, self.parts)
    }

    /// A comma, unless something has just been opened.
    fn separate(&mut self) {
        if !matches!(self.text.as_bytes().last(), None | Some(b'{' | b'[' | b':')) {
            self.text.push(',');
        }
    }

    fn key(&mut self, key: &str) {
        self.separate();
        self.text.push_str(&quoted(key));
        self.text.push(':');
    }

    /// An object with what is written meanwhile: an entry of a list, or of another object by its key.
    pub(super) fn object(&mut self, write: impl FnOnce(&mut Self)) {
        self.separate();
        self.text.push('{');
        write(self);
        self.text.push('}');
    }

    /// A list of objects.
    pub(super) fn objects<T>(&mut self, key: &str, items: &[T], mut write: impl FnMut(&mut Self, &T)) {
        self.key(key);
        self.text.push('[');
        for item in items {
            self.object(|json| write(json, item));
        }
        self.text.push(']');
    }

    pub(super) fn text(&mut self, key: &str, value: &str) {
        self.key(key);
        self.text.push_str(&quoted(value));
    }

    pub(super) fn number(&mut self, key: &str, value: f64) {
        self.key(key);
        let _ = write!(self.text, "{value}");
    }

    /// A short list of numbers.
    pub(super) fn numbers(&mut self, key: &str, values: &[f64]) {
        self.key(key);
        self.text.push('[');
        for value in values {
            self.separate();
            let _ = write!(self.text, "{value}");
        }
        self.text.push(']');
    }

    /// A long list of numbers, in single precision.
    pub(super) fn samples(&mut self, key: &str, values: impl Iterator<Item = f64>) {
        self.bytes(key, &values.flat_map(|value| (value as f32).to_le_bytes()).collect::<Vec<u8>>());
    }

    /// A long list of numbers, in double precision.
    pub(super) fn doubles(&mut self, key: &str, values: &[f64]) {
        self.bytes(key, &values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>());
    }

    fn bytes(&mut self, key: &str, bytes: &[u8]) {
        self.key(key);
        if bytes.len() < SEPARATE_BYTES {
            self.text.push('"');
            base64(bytes, &mut self.text);
            self.text.push('"');
            return;
        }
        let from = self.parts.len();
        self.parts.extend(bytes.chunks(PART_BYTES).map(|part| {
            let mut text = String::new();
            base64(part, &mut text);
            text
        }));
        let _ =
            write!(self.text, "{{\"bytes\":{},\"from\":{from},\"to\":{}}}", bytes.len(), self.parts.len());
    }
}

/// A string of JSON that may stand in a script element: there `</script` would end it, and `<!--` change its meaning.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            '<' | '>' | '&' | '\u{2028}' | '\u{2029}' | '\0'..='\u{1f}' | '\u{7f}' => {
                let _ = write!(quoted, "\\u{:04x}", c as u32);
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// Text of HTML, in elements and in quoted attributes.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            c => escaped.push(c),
        }
    }
    escaped
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8], text: &mut String) {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    text.reserve(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word =
            three.iter().enumerate().fold(0_u32, |word, (i, byte)| word | u32::from(*byte) << (16 - 8 * i));
        for i in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= three.len() { char::from(letter) } else { '=' });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_the_rfc() {
        let cases = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
        ];
        let encoded = |bytes: &[u8]| {
            let mut text = String::new();
            base64(bytes, &mut text);
            text
        };
        for (bytes, text) in cases {
            assert_eq!(encoded(bytes.as_bytes()), text);
        }
        assert_eq!(encoded(&[0xff, 0xfb, 0xf0]), "//vw");
    }

    #[test]
    fn objects_lists_and_numbers() {
        let mut json = Json::default();
        json.object(|json| {
            json.text("a", "x");
            json.number("b", 0.5);
            json.numbers("c", &[1.0, -2e-7]);
            json.objects("d", &[1, 2], |json, k| json.number("k", f64::from(*k)));
            json.objects("e", &[] as &[i32], |_, _| {});
            json.samples("f", [1.0].into_iter());
        });
        assert_eq!(
            json.into_texts().0,
            r#"{"a":"x","b":0.5,"c":[1,-0.0000002],"d":[{"k":1},{"k":2}],"e":[],"f":"AACAPw=="}"#
        );
    }

    #[test]
    fn long_samples_stand_beside_the_text() {
        let mut json = Json::default();
        json.object(|json| {
            json.doubles("t", &vec![1.5; SEPARATE_BYTES / 8]);
            json.samples("x", (0..PART_BYTES / 4 + 1).map(|_| 1.0));
        });
        let (text, parts) = json.into_texts();
        let expected = format!(
            r#"{{"t":{{"bytes":{SEPARATE_BYTES},"from":0,"to":1}},"x":{{"bytes":{},"from":1,"to":3}}}}"#,
            PART_BYTES + 4
        );
        assert_eq!(text, expected);
        assert_eq!(
            parts.iter().map(String::len).collect::<Vec<_>>(),
            [SEPARATE_BYTES / 3 * 4, PART_BYTES / 3 * 4, 8]
        );
        assert_eq!(parts[2], "AACAPw==");
    }

    #[test]
    fn no_text_leaves_its_place() {
        assert_eq!(quoted("</script><!--\n\"\\"), r#""\u003c/script\u003e\u003c!--\u000a\"\\""#);
        assert_eq!(escaped("<a href='\"&\">"), "&lt;a href=&#39;&quot;&amp;&quot;&gt;");
    }
}

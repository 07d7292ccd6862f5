//! What was derived, as text, Markdown and LaTeX: what every LaTeX has to be able to compile is looked at here without one.
//!
//! ```text
//! GUEN_LATEX=/tmp/reports cargo test -p guen-tests --test language report       # writes the documents, for pdflatex
//! ```

#[path = "../../workshop/guen-bare/src/plant.rs"]
mod plant;

use guen::Report;

hoop!(guen::mechanical_system);
appell!(guen::mechanical_system);
sled!(guen::mechanical_system);
trailer!(guen::mechanical_system);
turntable!(guen::mechanical_system);
cart!(guen::mechanical_system);
particle_pendulum!(guen::mechanical_system);

guen::mechanical_system! {
    /// Names that LaTeX and Markdown take for something else, and every function.
    pub system Odd_Names {
        constants { m_1 > 0, mass_of_the_body > 0, x_y_z, λ, k_ > 0, 质 > 0 }
        inputs { thrust_1 }
        coordinates {
            /// 100 % of $x$ & #1 ~ `a_b` \n {braces} ^ <tag> | [link](here)
            x_1,
            s_, θ, αβ,
        }
        parameters { u_1 = dot(x_1); eta_s = dot(s_); ω1 = dot(θ); }
        constraints { no_slip: dot(αβ) = exp(x_1)*dot(x_1)/质 + abs(s_)*dot(s_) + t*atan2(s_, m_1); }
        kinetic_energy = 1/2*mass_of_the_body*(dot(x_1)^2 + dot(s_)^2) + m_1/3*dot(θ)^2 + dot(αβ)^2/2;
        potential_energy = k_*(1 + x_1^2)^(2/3) + asin(s_/10) + sqrt(1 + θ^2) + ln(2 + cosh(x_1)) + λ*x_y_z*tan(θ);
        forces { thrust_1 - u_1 along u_1; }
    }
}

/// All reports of this file, the scenes' among them where systems have some.
fn reports() -> [&'static Report; 9] {
    [
        &hoop::REPORT,
        &appell::REPORT,
        &sled::REPORT,
        &trailer::REPORT,
        &turntable::REPORT,
        &cart::REPORT,
        &particle_pendulum::REPORT,
        &plant::robot::REPORT,
        &odd_names::REPORT,
    ]
}

/// Commands that a document may use: those of plain LaTeX and of `amsmath`, and those of its own preamble.
const COMMANDS: &[&str] = &[
    "documentclass",
    "usepackage",
    "ifPDFTeX",
    "else",
    "fi",
    "setlength",
    "parindent",
    "begin",
    "end",
    "section",
    "subsection",
    "item",
    "raggedright",
    "hangindent",
    "hangafter",
    "displaystyle",
    "par",
    "smallskip",
    "texttt",
    "textbackslash",
    "textasciicircum",
    "textasciitilde",
    "frac",
    "sqrt",
    "left",
    "right",
    "dot",
    "ddot",
    "mathrm",
    "text",
    "operatorname",
    "partial",
    "circ",
    "quad",
    "ldots",
    "sin",
    "cos",
    "tan",
    "cot",
    "arcsin",
    "arccos",
    "arctan",
    "sinh",
    "cosh",
    "tanh",
    "exp",
    "ln",
    "alpha",
    "beta",
    "gamma",
    "delta",
    "epsilon",
    "zeta",
    "eta",
    "theta",
    "iota",
    "kappa",
    "lambda",
    "mu",
    "nu",
    "xi",
    "pi",
    "rho",
    "sigma",
    "tau",
    "upsilon",
    "phi",
    "chi",
    "psi",
    "omega",
    "Gamma",
    "Delta",
    "Theta",
    "Lambda",
    "Xi",
    "Pi",
    "Sigma",
    "Upsilon",
    "Phi",
    "Psi",
    "Omega",
    "neq",
    "bigl",
    "bigr",
    "mathit",
];

/// The first thing in a document at which LaTeX would stop.
fn fault(document: &str) -> Option<String> {
    let mut depth = 0_i32;
    let mut in_math = false;
    let mut fences = Vec::new();
    let mut environments = Vec::new();
    let mut rest = document;
    while let Some(c) = rest.chars().next() {
        let here = rest;
        let told = |what: &str| Some(format!("{what} at `{}`", here.chars().take(40).collect::<String>()));
        rest = &rest[c.len_utf8()..];
        match c {
            '\\' => {
                let letters = rest.chars().take_while(char::is_ascii_alphabetic).count();
                let (name, after) = rest.split_at(letters);
                rest = after;
                match name {
                    "" => {
                        let mark = rest.chars().next()?;
                        if !"{}$&#%_,".contains(mark) {
                            return told("unknown mark");
                        }
                        rest = &rest[mark.len_utf8()..];
                    }
                    "begin" => environments.push(rest.split('}').next()),
                    "end" if environments.pop() != Some(rest.split('}').next()) => {
                        return told("no such begin");
                    }
                    "left" => fences.push(depth),
                    "right" if fences.pop() != Some(depth) => return told("no left"),
                    "frac" | "sqrt" | "dot" | "mathrm" | "operatorname"
                        if !after.starts_with(['{', '[', ' ']) =>
                    {
                        return told("no argument");
                    }
                    name if !COMMANDS.contains(&name) => return told("unknown command"),
                    _ => {}
                }
            }
            '{' => depth += 1,
            '}' => depth -= 1,
            '$' => in_math = !in_math,
            '_' | '^' if !in_math => return told("a script outside of mathematics"),
            '_' | '^' if rest.starts_with(['_', '^', ' ']) => return told("a script of nothing"),
            '&' | '#' | '%' | '~' => return told("a special character"),
            '\n' if in_math => return told("a formula over a line's end"),
            _ => {}
        }
        if depth < 0 {
            return told("a brace too many");
        }
    }
    let open = depth != 0 || in_math || !fences.is_empty() || !environments.is_empty();
    open.then(|| "something is left open".to_owned())
}

#[test]
fn the_search_for_faults_finds_them() {
    for document in [
        r"{",
        r"}",
        "$a",
        r"\frac12",
        r"\unknown",
        "a_b",
        "$a^^b$",
        r"\begin{itemize}",
        r"$\left(a$",
        r"$\left({a\right)}$",
        "50 %",
        r"a \; b",
        "$a\n$",
        r"\begin{a}\end{b}",
    ] {
        assert!(fault(document).is_some(), "{document}");
    }
    assert_eq!(fault(r"$\frac{a_{1}}{\left(b\right)^{2}}$ \textbackslash{} \{"), None);
}

#[test]
fn every_report_is_latex() {
    let folder = std::env::var_os("GUEN_LATEX").map(std::path::PathBuf::from);
    for report in reports() {
        let document = report.latex().to_string();
        assert_eq!(fault(&document), None, "{}: {document}", report.name);
        assert_eq!(fault(&report.latex().body().to_string()), None);
        if let Some(folder) = &folder {
            let file = folder.join(format!("{}.tex", report.name));
            guen_study::replace_file(file, |out| out.write_all(document.as_bytes())).unwrap();
        }
    }
}

/// Text, Markdown and LaTeX have the same sections, and a line for each line.
#[test]
fn the_three_say_the_same() {
    for report in reports() {
        let (markdown, latex) = (report.markdown(1).to_string(), report.latex().to_string());
        // Long formulas may be broken inside of parentheses.
        let latex = latex.replace(r"\bigl(", r"\left(").replace(r"\bigr)", r"\right)");
        for section in report.sections {
            let title = section.title;
            assert!(section.formulas.len() <= section.lines.len(), "{title}");
            assert!(markdown.contains(&format!("\n## {title}\n")), "{title}");
            assert!(latex.contains(&format!("\\subsection*{{{title}}}")), "{title}");
            for formula in section.formulas {
                assert!(markdown.contains(&format!("\n$${formula}$$\n")), "{formula}");
                assert!(latex.contains(&format!("$\\displaystyle {formula}$")), "{formula}");
            }
        }
        let lines: usize = report.sections.iter().map(|section| section.lines.len()).sum();
        let formulas: usize = report.sections.iter().map(|section| section.formulas.len()).sum();
        assert_eq!(latex.matches("\\item ").count(), lines - formulas, "{}", report.name);
        assert_eq!(markdown.matches("\n- ").count(), lines - formulas, "{}", report.name);
        // The equations of motion are formulas, each of them.
        assert_eq!(
            report.lines("Equations").len(),
            report.lines("Equations").iter().filter(|l| l.ends_with("= 0")).count()
        );
    }
}

/// `LATEX` are the formulas of `REPORT`, and nothing else.
#[test]
fn formulas_are_there_once() {
    let formulas = |report: &Report| -> Vec<&str> {
        report.sections.iter().flat_map(|section| section.formulas).copied().collect()
    };
    let lines: Vec<&str> = hoop::LATEX.sections.iter().flat_map(|section| section.lines).copied().collect();
    assert_eq!(lines, formulas(&hoop::REPORT));
    let pairs = hoop::REPORT.sections[2].formulas.iter().zip(hoop::LATEX.sections[0].lines);
    assert!(pairs.clone().count() == 6 && pairs.into_iter().all(|(a, b)| std::ptr::eq(*a, *b)));
}

#[test]
fn names_stay_names() {
    let (markdown, latex) =
        (odd_names::REPORT.markdown(3).to_string(), odd_names::REPORT.latex().to_string());
    assert!(markdown.starts_with("### Odd\\_Names\n"));
    let escaped = r"x\_1: 100 \% of \$x\$ \& \#1 \textasciitilde{} \texttt{a\_b} \textbackslash{}n \{braces\} \textasciicircum{} $<$tag$>$ $|$ [link](here)";
    assert!(latex.contains(escaped), "{latex}");
    assert!(
        markdown.contains(r"- x\_1: 100 % of \$x\$ & \#1 \~ `a_b` \\n {braces} ^ \<tag\> \| \[link\](here)"),
        "{markdown}"
    );
    assert!(
        latex.contains(r"\dot{x}_{1}")
            && latex.contains(r"\mathrm{mass}_{\mathrm{of},\mathrm{the},\mathrm{body}}")
    );
}

#[test]
fn properties_have_their_reasons() {
    let classification = odd_names::REPORT.lines("Classification");
    for reason in [
        "rheonomic: time occurs in `no_slip`",
        "acatastatic: a part without velocities is in `no_slip`",
        "not conservative: h changes, by forces, constraints that move, time",
    ] {
        assert!(classification.contains(&reason), "{classification:?}");
    }
    assert!(hoop::REPORT.lines("Classification").iter().all(|line| !line.contains(": h changes")));
    assert_eq!(hoop::REPORT.lines("Coordinates"), ["theta", "psi", "phi", "xi", "eta", "zeta"]);
    assert_eq!(plant::robot::REPORT.lines("Coordinates")[0], "x: The middle of the axle.");
    assert_eq!(hoop::REPORT.lines("Constants"), ["a > 0", "A > 0", "C > 0", "g = 9.81"]);
    let constants = plant::robot::REPORT.lines("Constants");
    assert!(constants.iter().any(|line| line.contains(" > 0: ")), "{constants:?}");
    assert_eq!(cart::REPORT.lines("Constants")[3], "I > 0 = 1/3*m*l^2");
    assert_eq!(plant::robot::REPORT.lines("Inputs").len(), 3);
}

/// Where a declaration degenerates is told by formulas, in the page that rustdoc shows too.
#[test]
fn edges_are_told() {
    let domain = |report: &'static Report| report.lines("Domain of the chart");
    let regular = "the mass matrix M is regular; `condition`, max_s M_ss (M^-1)_ss, says by how much";
    assert_eq!(domain(&hoop::REPORT), ["sin(theta) != 0"]);
    assert_eq!(domain(&turntable::REPORT), ["sin(theta) != 0"]);
    // What of the constants is left where rate and speed are not independent, and the matrix of both.
    assert_eq!(domain(&sled::REPORT), ["m - m*beta^2/(alpha^2 + beta^2 + k^2) != 0", regular]);
    assert_eq!(domain(&cart::REPORT).last(), Some(&regular));
    assert_eq!(domain(&plant::robot::REPORT).last(), Some(&regular));
    let chain = guen_benchmarks::systems::chain5::REPORT.lines("Domain of the chart");
    assert_eq!(chain.last(), Some(&regular), "{chain:?}");
}

/// Where an edge comes from, and at which states it is.
#[test]
fn edges_have_reasons() {
    let of_parameter = "the parameter eta2 does not determine a velocity where theta is a multiple of pi";
    assert_eq!(hoop::DOMAIN_REASONS, [of_parameter]);
    assert_eq!(hoop::REPORT.lines("Edges of the chart"), [format!("`sin(theta)`: {of_parameter}")]);
    let told = |names: &'static [&'static str], reasons: &'static [&'static str]| -> Vec<String> {
        names.iter().zip(reasons).map(|(name, reason)| format!("{name}: {reason}")).collect()
    };
    assert_eq!(
        told(&turntable::DOMAIN, &turntable::DOMAIN_REASONS),
        [
            "sin(theta): the parameters eta1 and eta2 do not determine the velocities where theta is a multiple of pi"
        ]
    );
    assert_eq!(
        told(&particle_pendulum::DOMAIN, &particle_pendulum::DOMAIN_REASONS),
        [
            "x^2/l^4 + y^2/l^4: the parameter omega does not determine a velocity where x = 0 and y = 0",
            "4*x^2 + 4*y^2: the constraint rod does not determine a velocity where x = 0 and y = 0"
        ]
    );
    // Where a sum is zero is no news; what it is of is.
    assert!(plant::robot::DOMAIN_REASONS[0].ends_with("the mass matrix is singular where it vanishes"));
    use guen_benchmarks::systems::chain5;
    let chain =
        "det M[w1, w2, w3, w4, w5]: the mass matrix is singular in w1, w2, w3, w4 and w5 where it vanishes";
    assert_eq!(told(&chain5::DOMAIN, &chain5::DOMAIN_REASONS), [chain]);
}

//! Large source files: many equal items, and small ones with large results.

/// Size of a megabyte in tests; the parser of a debug build is slow, so it is a sixteenth there.
const MB: usize = if cfg!(debug_assertions) { 1 << 16 } else { 1 << 20 };

fn graph(body: String) -> String {
    format!("graph A {{\n{body}\n}}\n")
}

/// The full count in a release build, a tenth in a debug build.
const fn scaled(count: usize) -> usize {
    if cfg!(debug_assertions) { count / 10 } else { count }
}

fn many(count: usize, item: impl Fn(usize) -> String) -> String {
    (0..count).map(item).collect()
}

/// Names and contents.
pub fn texts() -> Vec<(String, String)> {
    let mut texts: Vec<(String, String)> = vec![];
    let mut add = |name: &str, text: String| texts.push((name.to_owned(), text));
    for sign in [
        "(", "[", "{", "<", ")", "]", "}", ">", "\"", "-", "!", "/", ";", ":", ",", "\0", "§", " ", "\n", "/*", "()",
        "->",
    ] {
        add(&format!("1 MB of {sign:?}"), sign.repeat(MB / sign.len()));
        add(
            &format!("1 MB of {sign:?} in an argument"),
            graph(format!("node a = mul(k = {}1);", sign.repeat(MB / sign.len()))),
        );
    }
    tokens(&mut add);
    graphs(&mut add);
    connections(&mut add);
    errors(&mut add);
    texts
}

fn tokens(add: &mut impl FnMut(&str, String)) {
    let argument = |name: &str, value: String| graph(format!("node a = tune({name} = {value});"));
    add("digits", argument("ratio", "9".repeat(MB)));
    add("decimals", argument("ratio", format!("0.{}", "9".repeat(MB))));
    add("exponent", argument("ratio", format!("1e{}", "9".repeat(MB))));
    add("hex", argument("count", format!("0x{}", "f".repeat(MB))));
    add("unit", argument("gap", format!("1m{}", "*m".repeat(MB / 2))));
    add("power", argument("gap", format!("1m^{}", "9".repeat(MB))));
    add("sum", argument("ratio", format!("1{}", "+1".repeat(MB / 2))));
    add("list", argument("offset", format!("[{}]", "1,".repeat(MB / 2))));
    add(
        "deep expression",
        argument("ratio", format!("{}1{}", format!("{}(", "-".repeat(390)).repeat(60), ")".repeat(60))),
    );
    add("deep sum", argument("ratio", format!("{}1{}", format!("{}(", "1+".repeat(190)).repeat(60), ")".repeat(60))));
    add("arguments", graph(format!("node a = tune({});", "gap=1m,".repeat(MB / 7))));
    add("string", argument("frame", format!("\"{}\"", "\\\\".repeat(MB / 2))));
    add("path", graph(format!("node a = a{}();", "::a".repeat(MB / 3))));
    add("dots", graph(format!("a{} -> b;", ".a".repeat(MB / 2))));
    add("names", graph(format!("node {} = Ramp(); {} -> show();", "a".repeat(MB), "b".repeat(MB))));
    add("documentation", "/// d\n".repeat(MB / 6));
    add("documentation of statements", graph("/// d\n".repeat(MB / 6)));
    add("deep comment", format!("{}{}{}", "/*".repeat(60), "x".repeat(MB), "*/".repeat(60)));
    add("comments", "/**/".repeat(MB / 4));
    add("too large", " ".repeat(5 << 20));
}

fn graphs(add: &mut impl FnMut(&str, String)) {
    add(
        "10,000 graphs, each in the one before",
        many(scaled(10_000), |i| format!("graph G{i} {{ node g = G{}(); }}\n", i + 1))
            + &format!("graph G{} {{ }}", scaled(10_000)),
    );
    add(
        "10,000 graphs, each in the next",
        "graph G0 { }\n".to_owned() + &many(scaled(10_000), |i| format!("graph G{} {{ node g = G{i}(); }}\n", i + 1)),
    );
    add("50,000 graphs", many(scaled(50_000), |i| format!("graph G{i} {{ }}\n")));
    add("one graph 50,000 times", "graph A {}\n".repeat(scaled(50_000)));
    let doubled = |inner: &str, count: usize| {
        format!("graph G0 {{ {inner} }}\n")
            + &many(count, |i| format!("graph G{} {{ node a = G{i}(); node b = G{i}(); }}\n", i + 1))
    };
    add("a million nodes by doubling", doubled("node r = Ramp();", 20));
    add("doubling nothing", doubled("", 60));
    let wired = many(20, |i| format!("graph G{} {{ in x: u64; out y: u64; x -> G{i}() -> G{i}() -> y; }}\n", i + 1));
    add("doubling a chain", format!("graph G0 {{ in x: u64; out y: u64; x -> double() -> y; }}\n{wired}"));
    add(
        "doubling mistakes",
        format!("graph G0 {{ {} }}\n", "zzz -> yyy;".repeat(1000))
            + &many(20, |i| format!("graph G{} {{ node a = G{i}(); node b = G{i}(); }}\n", i + 1)),
    );
    add(
        "doubling claims",
        format!("graph G0 {{ {} }}\n", "claim c(a);".repeat(1000))
            + &many(20, |i| format!("graph G{} {{ node a = G{i}(); node b = G{i}(); }}\n", i + 1)),
    );
    add("recursion", "graph A { node a = A(); node b = A(); }".to_owned());
    add(
        "mutual recursion",
        many(60, |i| format!("graph G{i} {{ {} }}\n", many(60, |j| format!("node a{j} = G{j}();")))),
    );
    add(
        "ports of graphs",
        format!("graph P {{ {} }}\n", many(scaled(20_000), |i| format!("in p{i}: u64;")))
            + &graph(many(scaled(20_000), |i| format!("node n{i} = P();"))),
    );
    add(
        "parameters of graphs",
        format!("graph P({}) {{ }}\n", many(scaled(5_000), |i| format!("p{i}: u64 = 1,")))
            + &graph(many(scaled(5_000), |i| format!("node n{i} = P();"))),
    );
    add(
        "each in each",
        "graph G0 { in x: u64; x -> show(); }\n".to_owned()
            + &many(20, |i| {
                format!(
                    "graph G{} {{ in x: u64; x -> G{i}(); node l = list(); node e = G{i}() each; l -> e; }}\n",
                    i + 1
                )
            }),
    );
    add("imports", format!("use crate::{{{}}};", "Ramp,".repeat(MB / 5)));
    add("type", format!("graph A {{ in x: ({}); }}", "u64,".repeat(MB / 4)));
    add("claim", graph(format!("claim exclusive({});", "a,".repeat(MB / 2))));
}

fn connections(add: &mut impl FnMut(&str, String)) {
    let few = 1_000;
    add("chain", graph(format!("Ramp(){} -> show();", " -> double()".repeat(scaled(10_000)))));
    add("chain of one", graph(format!("node d = double(); d{};", " -> d".repeat(MB / 5))));
    add("filters", graph(format!("Ramp(){} -> show();", " -> maybe()".repeat(few))));
    add("delays", graph(format!("Ramp(){} -> show();", " -> double() delay 0".repeat(few))));
    add("generic nodes", graph(format!("Ramp(){} -> show();", " -> Latch()".repeat(scaled(10_000)))));
    let joined = |source: &dyn Fn(usize) -> String, count: usize| {
        let join = |i: usize| {
            format!(
                "node s{} = sum(); {}{i} -> s{}.a; r{} -> s{}.b;",
                i + 1,
                if i > 0 { "s" } else { "r" },
                i + 1,
                i + 1,
                i + 1
            )
        };
        graph(many(count + 1, source) + &many(count, join))
    };
    add("sources", joined(&|i| format!("node r{i} = Ramp();"), few));
    add("sources with a pace", joined(&|i| format!("node r{i} = Ramp() every {}ms;", i + 1), few));
    add("inputs", joined(&|i| format!("in r{i}: u64;"), few));
    add("fan", graph(format!("node r = Ramp(); {}", "r -> show();".repeat(scaled(20_000)))));
    add("generic fan", graph(format!("node r = Latch(); Ramp() -> r; {}", "r -> Latch();".repeat(scaled(20_000)))));
    add(
        "list to list",
        graph(format!("node r = Ramp(); [{}] -> [{}];", "r,".repeat(scaled(10_000)), "show(),".repeat(scaled(10_000)))),
    );
    add(
        "list to list by name",
        graph(format!(
            "node r = Ramp(); node s = show(); [{}] -> [{}];",
            "r,".repeat(scaled(100_000)),
            "s,".repeat(scaled(100_000))
        )),
    );
    add(
        "circle",
        graph(many(scaled(10_000), |i| format!("node n{i} = double(); n{i} -> n{};", (i + 1) % scaled(10_000)))),
    );
    let events = |count: usize| {
        let nodes = many(count, |i| format!("node t{i} = Pass(); node u{i} = Pass();"));
        let list = |name: &str, port: &str| many(count, |i| format!("{name}{i}.{port},"));
        graph(format!("{nodes} [{}] -> [{}];", list("t", "sent"), list("u", "put")))
    };
    add("more slots than numbers", events(260));
    let uneven = format!("node s = sum(); n{} -> halve() -> s.a; n0 -> s.b;", scaled(10_000));
    add(
        "rates",
        graph(format!(
            "node n0 = Ramp(); {}{uneven}",
            many(scaled(9_999), |i| format!("node n{} = double(); n{i} -> n{};", i + 1, i + 1))
        )),
    );
    add("many halves", graph(format!("Ramp(){} -> show();", " -> halve()".repeat(60))));
    add("each", graph(format!("node l = list(); {}", "l -> double() each;".repeat(few))));
    add(
        "parameters from connections",
        graph(
            "node r = Ramp();".to_owned()
                + &many(scaled(10_000), |i| format!("node m{i} = mul(); r -> m{i}.x; r -> m{i}.k;")),
        ),
    );
}

fn errors(add: &mut impl FnMut(&str, String)) {
    add(
        "unknown names",
        graph(
            many(scaled(20_000), |i| format!("node abcdefgh{i} = Ramp();"))
                + &many(scaled(20_000), |i| format!("abcdefhg{i} -> show();")),
        ),
    );
    add("unknown nodes", graph(many(scaled(50_000), |i| format!("node a{i} = Raamp{i}();"))));
    add(
        "unknown ports",
        format!("graph P {{ {} }}\n", many(scaled(10_000), |i| format!("in abcdefgh{i}: u64;")))
            + &graph("node p = P();".to_owned() + &many(scaled(10_000), |i| format!("p.abcdefhg{i} -> p.y;"))),
    );
    add("statements", graph("a b c;".repeat(MB / 6)));
    add("statements without end", graph("a -> b ".repeat(MB / 7)));
    add("items", "x y z\n".repeat(MB / 6));
    add("broken graphs", "graph x y z\n".repeat(MB / 12));
    add("names twice", graph("node a = Ramp();".repeat(scaled(30_000))));
    add("wrong values on one line", graph("node n = tune(gap = 1s);".repeat(scaled(40_000))));
}

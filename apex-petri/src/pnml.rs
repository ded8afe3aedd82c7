//! The net as PNML, the exchange format of Petri net tools (ISO/IEC 15909-2).

use super::Net;
use std::fmt::Write as _;

/// `net` as a PNML document with one place/transition net.
pub fn pnml(net: &Net) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<pnml xmlns=\"http://www.pnml.org/version-2009/grammar/pnml\">\n",
    );
    let _ = writeln!(text, "  <net id=\"net\" type=\"http://www.pnml.org/version-2009/grammar/ptnet\">");
    let _ = writeln!(text, "    <name><text>{}</text></name>\n    <page id=\"page\">", escaped(&net.name));
    for (i, place) in net.places.iter().enumerate() {
        let name = escaped(&place.name);
        let _ = write!(text, "      <place id=\"p{i}\"><name><text>{name}</text></name>");
        if place.initial > 0 {
            let _ = write!(text, "<initialMarking><text>{}</text></initialMarking>", place.initial);
        }
        text.push_str("</place>\n");
    }
    for (i, transition) in net.transitions.iter().enumerate() {
        let name = escaped(&transition.name);
        let _ = writeln!(text, "      <transition id=\"t{i}\"><name><text>{name}</text></name></transition>");
    }
    let mut count = 0;
    let mut arc = |source: String, target: String| {
        let _ = writeln!(
            text,
            "      <arc id=\"a{count}\" source=\"{source}\" target=\"{target}\"><inscription><text>1</text></inscription></arc>"
        );
        count += 1;
    };
    for (i, transition) in net.transitions.iter().enumerate() {
        transition.takes.iter().for_each(|p| arc(format!("p{}", p.index()), format!("t{i}")));
        transition.gives.iter().for_each(|p| arc(format!("t{i}"), format!("p{}", p.index())));
    }
    text.push_str("    </page>\n  </net>\n</pnml>\n");
    text
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

//! A program that streams bytes, as firmware does.

use crate::{
    Counts,
    browser::Browser,
    page::{RUNNING, studio_of, wiring},
};
use apex_rt::{Clock as _, Next, Observer as _, bytes::ByteStream, prelude::*};
use apex_studio::Remote;
use std::{
    io::{Read as _, Write as _},
    net::TcpListener,
    thread,
    time::Duration,
};

/// Runs the program for whoever connects, and describes it whenever something comes.
fn firmware(listener: &TcpListener) {
    let (mut line, _) = listener.accept().expect("the studio connects");
    line.set_read_timeout(Some(Duration::from_millis(2))).expect("a socket");
    let mut asks = line.try_clone().expect("a socket");
    let (mut program, mut clock) = (Counts::new(), SimClock::until(Time::MAX));
    // Someone else has heard the beginning.
    line.write_all(&[7, 0, 0]).expect("room for it");
    let mut stream = ByteStream::new(|bytes: &[u8]| drop(line.write_all(bytes)));
    loop {
        if asks.read(&mut [0; 16]).is_ok_and(|count| count > 0) {
            stream.describe(&program);
        }
        let now = clock.now();
        stream.before_reaction(now, &mut program);
        let next = program.react_with(now, &mut stream);
        if !matches!(next, Next::At(time) if clock.wait_until(time)) {
            return;
        }
    }
}

#[test]
fn firmware_is_shown_from_the_middle_of_its_bytes() {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = format!("bytes:{}", listener.local_addr().expect("an address"));
    thread::spawn(move || firmware(&listener));
    let Some(mut page) = Browser::open(&studio_of(Remote { address }, false).0) else { return };
    page.wait_for(RUNNING);
    page.wait_for("document.getElementById('name').textContent === 'Counts'");
    wiring(&mut page);
    page.wait_for("document.querySelector('[data-item=\"gated.gate\"].is-active')");
    page.wait_for("document.querySelector('[data-item=count].is-firing')");
    page.wait_for("parseFloat(document.getElementById('now').textContent) > 1");
    assert_eq!(page.value("document.getElementById('pace').hidden"), true);
    assert_eq!(page.complaints, Vec::<String>::new());
}

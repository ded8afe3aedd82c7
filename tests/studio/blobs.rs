//! Figure 9.1 of the dissertation: sliders for the parameters, and beside them the image with the blobs.

use crate::{
    browser::Browser,
    page::{start_of, studio_for_file},
    socket,
};
use ::blobs::{Prototype, film};
use apex_rt::prelude::*;
use std::{fs, path::PathBuf};

fn belt() -> PathBuf {
    socket("belt.mcap")
}

/// The robot with its film, which it plays again and again.
fn prototype() -> Prototype {
    let mut robot = Prototype::new();
    robot.set_param("bag.file", belt().to_str().expect("UTF-8").to_owned()).expect("a parameter");
    robot
}

#[test]
fn sliders_change_the_blobs_in_the_image_beside_them() {
    drop(fs::remove_file(belt()));
    film(&belt(), 1.0).expect("a film");
    let _robot = start_of("blobs", prototype, 3600);
    let Some(mut page) = Browser::open(&studio_for_file("blobs", "../robots/blobs/blobs.afg")) else { return };
    page.click("document.querySelector('[data-tab=values]')");
    let row = "document.querySelector('[data-channel=\"find.mark.marked\"]')";
    page.wait_for(row);
    page.click(&format!("{row}.querySelector('input')"));
    page.click("document.querySelector('[data-tab=params]')");
    let image = format!("{row}.querySelector('canvas.image')");
    page.wait_for(&format!("{image}?.offsetParent"));
    // Pixels in the colour of marks.
    let marked = format!(
        "((image) => {{
            const {{ width, height }} = image;
            const copy = new OffscreenCanvas(width, height).getContext('2d', {{ willReadFrequently: true }});
            copy.drawImage(image, 0, 0);
            const {{ data }} = copy.getImageData(0, 0, width, height);
            return data.filter((_, i) => i % 4 === 0 && data[i] === 255 && data[i + 1] === 64 && data[i + 2] === 0).length;
        }})({image})"
    );
    page.wait_for(&format!("{marked} > 100"));
    let param = "document.querySelector('[data-param=\"find.find.min_area\"]')";
    page.fill(&format!("{param}.querySelector('input[type=text]')"), "5000");
    page.wait_for(&format!("{marked} === 0"));
    page.fill(&format!("{param}.querySelector('input[type=text]')"), "60");
    page.wait_for(&format!("{marked} > 100"));
    // Only what is pinned stands beside the sliders.
    let others = "[...document.querySelectorAll('#values .value')].filter((row) => row.offsetParent).length";
    assert_eq!(page.value(others), 1);
    page.click("document.querySelector('[data-tab=active]')");
    page.wait_for(&format!("{image}.offsetParent === null"));
    assert_eq!(page.complaints, Vec::<String>::new());
    drop(fs::remove_file(belt()));
}

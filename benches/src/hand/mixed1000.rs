//! Generated: the regions of `mixed1000` by hand. Each function is one tick of a region.

use crate::{graphs::Mixed1000, nodes::{gate, merge, op, weigh}};

/// Region 0, node by node.
pub fn region0(n0: u64, mut acc: u64) -> u64 {
    let n0 = Some(n0);
    let n1 = n0.and_then(|x| gate(&x));
    let n2 = n0.map(|x| op(&x, 2));
    let n3 = n0.zip(n0).map(|(a, b)| merge(&a, &b, 3));
    let n4 = n3.and_then(|x| gate(&x));
    let n5 = n0.map(|x| op(&x, 5));
    let n6 = n4.map(|x| op(&x, 6));
    let n7 = n4.zip(n1).map(|(a, b)| merge(&a, &b, 7));
    let n8 = n6.and_then(|x| gate(&x));
    let n9 = n2.map(|x| op(&x, 9));
    let n10 = n3.map(|x| op(&x, 10));
    let n11 = n0.map(|x| op(&x, 11));
    let n12 = n3.and_then(|x| gate(&x));
    let n13 = n12.map(|x| op(&x, 13));
    let n14 = n9.zip(n8).map(|(a, b)| merge(&a, &b, 14));
    let n15 = n8.and_then(|x| gate(&x));
    let n16 = n8.and_then(|x| gate(&x));
    let n17 = n14.and_then(|x| gate(&x));
    let n18 = n14.map(|x| op(&x, 18));
    let n19 = n3.map(|x| op(&x, 19));
    let n20 = n4.zip(n5).map(|(a, b)| merge(&a, &b, 20));
    let n21 = n12.map(|x| op(&x, 21));
    let n22 = n10.map(|x| op(&x, 22));
    let n23 = n22.map(|x| op(&x, 23));
    let n24 = n11.map(|x| op(&x, 24));
    let n25 = n12.map(|x| op(&x, 25));
    let n26 = n17.map(|x| op(&x, 26));
    let n27 = n18.map(|x| op(&x, 27));
    let n28 = n25.map(|x| op(&x, 28));
    let n29 = n14.map(|x| op(&x, 29));
    let n30 = n26.map(|x| op(&x, 30));
    let n31 = n30.zip(n19).map(|(a, b)| merge(&a, &b, 31));
    let n32 = n24.map(|x| op(&x, 32));
    let n33 = n17.and_then(|x| gate(&x));
    let n34 = n26.map(|x| op(&x, 34));
    let n35 = n20.map(|x| op(&x, 35));
    let n36 = n32.map(|x| op(&x, 36));
    let n37 = n35.map(|x| op(&x, 37));
    let n38 = n25.zip(n33).map(|(a, b)| merge(&a, &b, 38));
    let n39 = n37.map(|x| op(&x, 39));
    let n40 = n36.map(|x| op(&x, 40));
    let n41 = n30.map(|x| op(&x, 41));
    let n42 = n27.zip(n29).map(|(a, b)| merge(&a, &b, 42));
    let n43 = n31.zip(n42).map(|(a, b)| merge(&a, &b, 43));
    let n44 = n43.map(|x| op(&x, 44));
    let n45 = n30.zip(n44).map(|(a, b)| merge(&a, &b, 45));
    let n46 = n35.map(|x| op(&x, 46));
    let n47 = n42.zip(n46).map(|(a, b)| merge(&a, &b, 47));
    let n48 = n32.map(|x| op(&x, 48));
    let n49 = n43.map(|x| op(&x, 49));
    let n50 = n43.zip(n48).map(|(a, b)| merge(&a, &b, 50));
    let n51 = n44.map(|x| op(&x, 51));
    let n52 = n48.zip(n40).map(|(a, b)| merge(&a, &b, 52));
    let n53 = n37.map(|x| op(&x, 53));
    let n54 = n41.map(|x| op(&x, 54));
    let n55 = n41.and_then(|x| gate(&x));
    let n56 = n42.map(|x| op(&x, 56));
    let n57 = n44.map(|x| op(&x, 57));
    let n58 = n44.map(|x| op(&x, 58));
    let n59 = n46.map(|x| op(&x, 59));
    let n60 = n47.zip(n49).map(|(a, b)| merge(&a, &b, 60));
    let n61 = n57.map(|x| op(&x, 61));
    let n62 = n51.map(|x| op(&x, 62));
    let n63 = n56.map(|x| op(&x, 63));
    let n64 = n63.map(|x| op(&x, 64));
    let n65 = n61.and_then(|x| gate(&x));
    let n66 = n65.map(|x| op(&x, 66));
    let n67 = n66.zip(n62).map(|(a, b)| merge(&a, &b, 67));
    let n68 = n55.map(|x| op(&x, 68));
    let n69 = n63.and_then(|x| gate(&x));
    let n70 = n61.and_then(|x| gate(&x));
    let n71 = n65.zip(n59).map(|(a, b)| merge(&a, &b, 71));
    let n72 = n69.and_then(|x| gate(&x));
    let n73 = n70.map(|x| op(&x, 73));
    let n74 = n71.map(|x| op(&x, 74));
    let n75 = n62.zip(n60).map(|(a, b)| merge(&a, &b, 75));
    let n76 = n70.map(|x| op(&x, 76));
    let n77 = n64.map(|x| op(&x, 77));
    let n78 = n71.map(|x| op(&x, 78));
    let n79 = n69.map(|x| op(&x, 79));
    let n80 = n71.map(|x| op(&x, 80));
    let n81 = n79.map(|x| op(&x, 81));
    let n82 = n71.map(|x| op(&x, 82));
    let n83 = n82.map(|x| op(&x, 83));
    let n84 = n81.map(|x| op(&x, 84));
    let n85 = n78.map(|x| op(&x, 85));
    let n86 = n72.zip(n77).map(|(a, b)| merge(&a, &b, 86));
    let n87 = n80.map(|x| op(&x, 87));
    let n88 = n74.map(|x| op(&x, 88));
    let n89 = n76.zip(n83).map(|(a, b)| merge(&a, &b, 89));
    let n90 = n83.map(|x| op(&x, 90));
    let n91 = n79.map(|x| op(&x, 91));
    let n92 = n88.zip(n82).map(|(a, b)| merge(&a, &b, 92));
    let n93 = n83.zip(n84).map(|(a, b)| merge(&a, &b, 93));
    let n94 = n79.zip(n85).map(|(a, b)| merge(&a, &b, 94));
    let n95 = n89.map(|x| op(&x, 95));
    let n96 = n93.zip(n87).map(|(a, b)| merge(&a, &b, 96));
    let n97 = n92.zip(n88).map(|(a, b)| merge(&a, &b, 97));
    let n98 = n93.map(|x| op(&x, 98));
    let n99 = n85.map(|x| op(&x, 99));
    if let Some(x) = n7 {
        acc = weigh(acc, x, 7);
    }
    if let Some(x) = n13 {
        acc = weigh(acc, x, 13);
    }
    if let Some(x) = n15 {
        acc = weigh(acc, x, 15);
    }
    if let Some(x) = n16 {
        acc = weigh(acc, x, 16);
    }
    if let Some(x) = n21 {
        acc = weigh(acc, x, 21);
    }
    if let Some(x) = n23 {
        acc = weigh(acc, x, 23);
    }
    if let Some(x) = n28 {
        acc = weigh(acc, x, 28);
    }
    if let Some(x) = n34 {
        acc = weigh(acc, x, 34);
    }
    if let Some(x) = n38 {
        acc = weigh(acc, x, 38);
    }
    if let Some(x) = n39 {
        acc = weigh(acc, x, 39);
    }
    if let Some(x) = n45 {
        acc = weigh(acc, x, 45);
    }
    if let Some(x) = n50 {
        acc = weigh(acc, x, 50);
    }
    if let Some(x) = n52 {
        acc = weigh(acc, x, 52);
    }
    if let Some(x) = n53 {
        acc = weigh(acc, x, 53);
    }
    if let Some(x) = n54 {
        acc = weigh(acc, x, 54);
    }
    if let Some(x) = n58 {
        acc = weigh(acc, x, 58);
    }
    if let Some(x) = n67 {
        acc = weigh(acc, x, 67);
    }
    if let Some(x) = n68 {
        acc = weigh(acc, x, 68);
    }
    if let Some(x) = n73 {
        acc = weigh(acc, x, 73);
    }
    if let Some(x) = n75 {
        acc = weigh(acc, x, 75);
    }
    if let Some(x) = n86 {
        acc = weigh(acc, x, 86);
    }
    if let Some(x) = n90 {
        acc = weigh(acc, x, 90);
    }
    if let Some(x) = n91 {
        acc = weigh(acc, x, 91);
    }
    if let Some(x) = n94 {
        acc = weigh(acc, x, 94);
    }
    if let Some(x) = n95 {
        acc = weigh(acc, x, 95);
    }
    if let Some(x) = n96 {
        acc = weigh(acc, x, 96);
    }
    if let Some(x) = n97 {
        acc = weigh(acc, x, 97);
    }
    if let Some(x) = n98 {
        acc = weigh(acc, x, 98);
    }
    if let Some(x) = n99 {
        acc = weigh(acc, x, 99);
    }
    if let Some(x) = n9 {
        acc = region6(x, acc);
    }
    if let Some(x) = n44 {
        acc = region4(x, acc);
    }
    acc
}

/// Region 4, node by node.
pub fn region4(n400: u64, mut acc: u64) -> u64 {
    let n400 = Some(n400);
    let n401 = n400.map(|x| op(&x, 401));
    let n402 = n400.map(|x| op(&x, 402));
    let n403 = n400.map(|x| op(&x, 403));
    let n404 = n403.zip(n403).map(|(a, b)| merge(&a, &b, 404));
    let n405 = n402.and_then(|x| gate(&x));
    let n406 = n400.map(|x| op(&x, 406));
    let n407 = n401.map(|x| op(&x, 407));
    let n408 = n400.map(|x| op(&x, 408));
    let n409 = n401.zip(n408).map(|(a, b)| merge(&a, &b, 409));
    let n410 = n405.map(|x| op(&x, 410));
    let n411 = n402.map(|x| op(&x, 411));
    let n412 = n410.map(|x| op(&x, 412));
    let n413 = n403.and_then(|x| gate(&x));
    let n414 = n404.map(|x| op(&x, 414));
    let n415 = n414.zip(n401).map(|(a, b)| merge(&a, &b, 415));
    let n416 = n410.map(|x| op(&x, 416));
    let n417 = n403.map(|x| op(&x, 417));
    let n418 = n404.and_then(|x| gate(&x));
    let n419 = n411.and_then(|x| gate(&x));
    let n420 = n409.and_then(|x| gate(&x));
    let n421 = n412.map(|x| op(&x, 421));
    let n422 = n418.and_then(|x| gate(&x));
    let n423 = n415.and_then(|x| gate(&x));
    let n424 = n414.map(|x| op(&x, 424));
    let n425 = n409.map(|x| op(&x, 425));
    let n426 = n419.map(|x| op(&x, 426));
    let n427 = n420.map(|x| op(&x, 427));
    let n428 = n424.map(|x| op(&x, 428));
    let n429 = n414.and_then(|x| gate(&x));
    let n430 = n421.zip(n416).map(|(a, b)| merge(&a, &b, 430));
    let n431 = n422.map(|x| op(&x, 431));
    let n432 = n417.map(|x| op(&x, 432));
    let n433 = n418.map(|x| op(&x, 433));
    let n434 = n422.zip(n421).map(|(a, b)| merge(&a, &b, 434));
    let n435 = n420.map(|x| op(&x, 435));
    let n436 = n420.zip(n423).map(|(a, b)| merge(&a, &b, 436));
    let n437 = n421.zip(n433).map(|(a, b)| merge(&a, &b, 437));
    let n438 = n422.zip(n432).map(|(a, b)| merge(&a, &b, 438));
    let n439 = n430.map(|x| op(&x, 439));
    let n440 = n429.and_then(|x| gate(&x));
    let n441 = n435.zip(n440).map(|(a, b)| merge(&a, &b, 441));
    let n442 = n433.and_then(|x| gate(&x));
    let n443 = n428.map(|x| op(&x, 443));
    let n444 = n439.map(|x| op(&x, 444));
    let n445 = n433.and_then(|x| gate(&x));
    let n446 = n444.map(|x| op(&x, 446));
    let n447 = n439.map(|x| op(&x, 447));
    let n448 = n439.map(|x| op(&x, 448));
    let n449 = n444.and_then(|x| gate(&x));
    let n450 = n444.zip(n440).map(|(a, b)| merge(&a, &b, 450));
    let n451 = n435.map(|x| op(&x, 451));
    let n452 = n438.and_then(|x| gate(&x));
    let n453 = n438.and_then(|x| gate(&x));
    let n454 = n444.and_then(|x| gate(&x));
    let n455 = n453.map(|x| op(&x, 455));
    let n456 = n451.zip(n446).map(|(a, b)| merge(&a, &b, 456));
    let n457 = n444.zip(n452).map(|(a, b)| merge(&a, &b, 457));
    let n458 = n446.map(|x| op(&x, 458));
    let n459 = n447.map(|x| op(&x, 459));
    let n460 = n445.map(|x| op(&x, 460));
    let n461 = n460.zip(n451).map(|(a, b)| merge(&a, &b, 461));
    let n462 = n451.and_then(|x| gate(&x));
    let n463 = n458.map(|x| op(&x, 463));
    let n464 = n452.map(|x| op(&x, 464));
    let n465 = n450.map(|x| op(&x, 465));
    let n466 = n454.map(|x| op(&x, 466));
    let n467 = n462.map(|x| op(&x, 467));
    let n468 = n453.map(|x| op(&x, 468));
    let n469 = n458.map(|x| op(&x, 469));
    let n470 = n464.map(|x| op(&x, 470));
    let n471 = n458.map(|x| op(&x, 471));
    let n472 = n462.map(|x| op(&x, 472));
    let n473 = n459.map(|x| op(&x, 473));
    let n474 = n466.map(|x| op(&x, 474));
    let n475 = n461.map(|x| op(&x, 475));
    let n476 = n465.zip(n472).map(|(a, b)| merge(&a, &b, 476));
    let n477 = n468.map(|x| op(&x, 477));
    let n478 = n462.map(|x| op(&x, 478));
    let n479 = n475.and_then(|x| gate(&x));
    let n480 = n470.map(|x| op(&x, 480));
    let n481 = n479.zip(n478).map(|(a, b)| merge(&a, &b, 481));
    let n482 = n472.zip(n479).map(|(a, b)| merge(&a, &b, 482));
    let n483 = n479.zip(n467).map(|(a, b)| merge(&a, &b, 483));
    let n484 = n473.zip(n481).map(|(a, b)| merge(&a, &b, 484));
    let n485 = n473.zip(n469).map(|(a, b)| merge(&a, &b, 485));
    let n486 = n472.zip(n476).map(|(a, b)| merge(&a, &b, 486));
    let n487 = n479.map(|x| op(&x, 487));
    let n488 = n478.map(|x| op(&x, 488));
    let n489 = n481.zip(n484).map(|(a, b)| merge(&a, &b, 489));
    let n490 = n478.zip(n475).map(|(a, b)| merge(&a, &b, 490));
    let n491 = n490.zip(n485).map(|(a, b)| merge(&a, &b, 491));
    let n492 = n478.map(|x| op(&x, 492));
    let n493 = n480.zip(n478).map(|(a, b)| merge(&a, &b, 493));
    let n494 = n479.and_then(|x| gate(&x));
    let n495 = n484.map(|x| op(&x, 495));
    let n496 = n494.map(|x| op(&x, 496));
    let n497 = n483.map(|x| op(&x, 497));
    let n498 = n489.and_then(|x| gate(&x));
    let n499 = n495.map(|x| op(&x, 499));
    if let Some(x) = n406 {
        acc = weigh(acc, x, 406);
    }
    if let Some(x) = n407 {
        acc = weigh(acc, x, 407);
    }
    if let Some(x) = n413 {
        acc = weigh(acc, x, 413);
    }
    if let Some(x) = n425 {
        acc = weigh(acc, x, 425);
    }
    if let Some(x) = n426 {
        acc = weigh(acc, x, 426);
    }
    if let Some(x) = n427 {
        acc = weigh(acc, x, 427);
    }
    if let Some(x) = n431 {
        acc = weigh(acc, x, 431);
    }
    if let Some(x) = n434 {
        acc = weigh(acc, x, 434);
    }
    if let Some(x) = n436 {
        acc = weigh(acc, x, 436);
    }
    if let Some(x) = n437 {
        acc = weigh(acc, x, 437);
    }
    if let Some(x) = n441 {
        acc = weigh(acc, x, 441);
    }
    if let Some(x) = n442 {
        acc = weigh(acc, x, 442);
    }
    if let Some(x) = n443 {
        acc = weigh(acc, x, 443);
    }
    if let Some(x) = n448 {
        acc = weigh(acc, x, 448);
    }
    if let Some(x) = n449 {
        acc = weigh(acc, x, 449);
    }
    if let Some(x) = n455 {
        acc = weigh(acc, x, 455);
    }
    if let Some(x) = n456 {
        acc = weigh(acc, x, 456);
    }
    if let Some(x) = n457 {
        acc = weigh(acc, x, 457);
    }
    if let Some(x) = n463 {
        acc = weigh(acc, x, 463);
    }
    if let Some(x) = n471 {
        acc = weigh(acc, x, 471);
    }
    if let Some(x) = n474 {
        acc = weigh(acc, x, 474);
    }
    if let Some(x) = n477 {
        acc = weigh(acc, x, 477);
    }
    if let Some(x) = n482 {
        acc = weigh(acc, x, 482);
    }
    if let Some(x) = n486 {
        acc = weigh(acc, x, 486);
    }
    if let Some(x) = n487 {
        acc = weigh(acc, x, 487);
    }
    if let Some(x) = n488 {
        acc = weigh(acc, x, 488);
    }
    if let Some(x) = n491 {
        acc = weigh(acc, x, 491);
    }
    if let Some(x) = n492 {
        acc = weigh(acc, x, 492);
    }
    if let Some(x) = n493 {
        acc = weigh(acc, x, 493);
    }
    if let Some(x) = n496 {
        acc = weigh(acc, x, 496);
    }
    if let Some(x) = n497 {
        acc = weigh(acc, x, 497);
    }
    if let Some(x) = n498 {
        acc = weigh(acc, x, 498);
    }
    if let Some(x) = n499 {
        acc = weigh(acc, x, 499);
    }
    if let Some(x) = n428 {
        acc = region9(x, acc);
    }
    acc
}

/// Region 6, node by node.
pub fn region6(n600: u64, mut acc: u64) -> u64 {
    let n600 = Some(n600);
    let n601 = n600.map(|x| op(&x, 601));
    let n602 = n601.and_then(|x| gate(&x));
    let n603 = n600.map(|x| op(&x, 603));
    let n604 = n600.and_then(|x| gate(&x));
    let n605 = n600.and_then(|x| gate(&x));
    let n606 = n602.zip(n601).map(|(a, b)| merge(&a, &b, 606));
    let n607 = n600.zip(n602).map(|(a, b)| merge(&a, &b, 607));
    let n608 = n602.map(|x| op(&x, 608));
    let n609 = n600.map(|x| op(&x, 609));
    let n610 = n608.map(|x| op(&x, 610));
    let n611 = n608.map(|x| op(&x, 611));
    let n612 = n610.and_then(|x| gate(&x));
    let n613 = n600.zip(n610).map(|(a, b)| merge(&a, &b, 613));
    let n614 = n613.and_then(|x| gate(&x));
    let n615 = n606.map(|x| op(&x, 615));
    let n616 = n603.map(|x| op(&x, 616));
    let n617 = n604.map(|x| op(&x, 617));
    let n618 = n615.map(|x| op(&x, 618));
    let n619 = n610.map(|x| op(&x, 619));
    let n620 = n608.map(|x| op(&x, 620));
    let n621 = n619.map(|x| op(&x, 621));
    let n622 = n611.map(|x| op(&x, 622));
    let n623 = n607.zip(n613).map(|(a, b)| merge(&a, &b, 623));
    let n624 = n617.map(|x| op(&x, 624));
    let n625 = n615.map(|x| op(&x, 625));
    let n626 = n610.zip(n625).map(|(a, b)| merge(&a, &b, 626));
    let n627 = n616.map(|x| op(&x, 627));
    let n628 = n614.zip(n627).map(|(a, b)| merge(&a, &b, 628));
    let n629 = n618.map(|x| op(&x, 629));
    let n630 = n616.map(|x| op(&x, 630));
    let n631 = n618.map(|x| op(&x, 631));
    let n632 = n631.zip(n621).map(|(a, b)| merge(&a, &b, 632));
    let n633 = n629.map(|x| op(&x, 633));
    let n634 = n620.map(|x| op(&x, 634));
    let n635 = n629.map(|x| op(&x, 635));
    let n636 = n629.map(|x| op(&x, 636));
    let n637 = n630.zip(n627).map(|(a, b)| merge(&a, &b, 637));
    let n638 = n628.map(|x| op(&x, 638));
    let n639 = n635.map(|x| op(&x, 639));
    let n640 = n629.zip(n632).map(|(a, b)| merge(&a, &b, 640));
    let n641 = n625.map(|x| op(&x, 641));
    let n642 = n626.map(|x| op(&x, 642));
    let n643 = n634.zip(n631).map(|(a, b)| merge(&a, &b, 643));
    let n644 = n637.map(|x| op(&x, 644));
    let n645 = n630.map(|x| op(&x, 645));
    let n646 = n642.map(|x| op(&x, 646));
    let n647 = n637.map(|x| op(&x, 647));
    let n648 = n634.map(|x| op(&x, 648));
    let n649 = n640.map(|x| op(&x, 649));
    let n650 = n634.zip(n636).map(|(a, b)| merge(&a, &b, 650));
    let n651 = n637.and_then(|x| gate(&x));
    let n652 = n642.zip(n647).map(|(a, b)| merge(&a, &b, 652));
    let n653 = n646.and_then(|x| gate(&x));
    let n654 = n647.map(|x| op(&x, 654));
    let n655 = n645.map(|x| op(&x, 655));
    let n656 = n652.zip(n642).map(|(a, b)| merge(&a, &b, 656));
    let n657 = n645.map(|x| op(&x, 657));
    let n658 = n643.and_then(|x| gate(&x));
    let n659 = n654.zip(n645).map(|(a, b)| merge(&a, &b, 659));
    let n660 = n647.map(|x| op(&x, 660));
    let n661 = n654.map(|x| op(&x, 661));
    let n662 = n649.zip(n658).map(|(a, b)| merge(&a, &b, 662));
    let n663 = n660.zip(n659).map(|(a, b)| merge(&a, &b, 663));
    let n664 = n662.map(|x| op(&x, 664));
    let n665 = n652.map(|x| op(&x, 665));
    let n666 = n659.zip(n653).map(|(a, b)| merge(&a, &b, 666));
    let n667 = n653.map(|x| op(&x, 667));
    let n668 = n652.zip(n663).map(|(a, b)| merge(&a, &b, 668));
    let n669 = n653.zip(n659).map(|(a, b)| merge(&a, &b, 669));
    let n670 = n665.and_then(|x| gate(&x));
    let n671 = n662.map(|x| op(&x, 671));
    let n672 = n671.map(|x| op(&x, 672));
    let n673 = n665.map(|x| op(&x, 673));
    let n674 = n664.map(|x| op(&x, 674));
    let n675 = n663.and_then(|x| gate(&x));
    let n676 = n672.map(|x| op(&x, 676));
    let n677 = n676.map(|x| op(&x, 677));
    let n678 = n676.map(|x| op(&x, 678));
    let n679 = n668.zip(n672).map(|(a, b)| merge(&a, &b, 679));
    let n680 = n675.and_then(|x| gate(&x));
    let n681 = n669.zip(n673).map(|(a, b)| merge(&a, &b, 681));
    let n682 = n674.zip(n677).map(|(a, b)| merge(&a, &b, 682));
    let n683 = n675.map(|x| op(&x, 683));
    let n684 = n668.map(|x| op(&x, 684));
    let n685 = n673.and_then(|x| gate(&x));
    let n686 = n678.map(|x| op(&x, 686));
    let n687 = n675.zip(n675).map(|(a, b)| merge(&a, &b, 687));
    let n688 = n681.zip(n678).map(|(a, b)| merge(&a, &b, 688));
    let n689 = n674.map(|x| op(&x, 689));
    let n690 = n679.map(|x| op(&x, 690));
    let n691 = n677.map(|x| op(&x, 691));
    let n692 = n679.zip(n690).map(|(a, b)| merge(&a, &b, 692));
    let n693 = n688.map(|x| op(&x, 693));
    let n694 = n681.and_then(|x| gate(&x));
    let n695 = n680.map(|x| op(&x, 695));
    let n696 = n682.zip(n690).map(|(a, b)| merge(&a, &b, 696));
    let n697 = n683.map(|x| op(&x, 697));
    let n698 = n685.map(|x| op(&x, 698));
    let n699 = n692.map(|x| op(&x, 699));
    if let Some(x) = n605 {
        acc = weigh(acc, x, 605);
    }
    if let Some(x) = n609 {
        acc = weigh(acc, x, 609);
    }
    if let Some(x) = n612 {
        acc = weigh(acc, x, 612);
    }
    if let Some(x) = n622 {
        acc = weigh(acc, x, 622);
    }
    if let Some(x) = n623 {
        acc = weigh(acc, x, 623);
    }
    if let Some(x) = n624 {
        acc = weigh(acc, x, 624);
    }
    if let Some(x) = n633 {
        acc = weigh(acc, x, 633);
    }
    if let Some(x) = n638 {
        acc = weigh(acc, x, 638);
    }
    if let Some(x) = n639 {
        acc = weigh(acc, x, 639);
    }
    if let Some(x) = n641 {
        acc = weigh(acc, x, 641);
    }
    if let Some(x) = n644 {
        acc = weigh(acc, x, 644);
    }
    if let Some(x) = n648 {
        acc = weigh(acc, x, 648);
    }
    if let Some(x) = n650 {
        acc = weigh(acc, x, 650);
    }
    if let Some(x) = n651 {
        acc = weigh(acc, x, 651);
    }
    if let Some(x) = n655 {
        acc = weigh(acc, x, 655);
    }
    if let Some(x) = n656 {
        acc = weigh(acc, x, 656);
    }
    if let Some(x) = n657 {
        acc = weigh(acc, x, 657);
    }
    if let Some(x) = n661 {
        acc = weigh(acc, x, 661);
    }
    if let Some(x) = n666 {
        acc = weigh(acc, x, 666);
    }
    if let Some(x) = n667 {
        acc = weigh(acc, x, 667);
    }
    if let Some(x) = n670 {
        acc = weigh(acc, x, 670);
    }
    if let Some(x) = n684 {
        acc = weigh(acc, x, 684);
    }
    if let Some(x) = n686 {
        acc = weigh(acc, x, 686);
    }
    if let Some(x) = n687 {
        acc = weigh(acc, x, 687);
    }
    if let Some(x) = n689 {
        acc = weigh(acc, x, 689);
    }
    if let Some(x) = n691 {
        acc = weigh(acc, x, 691);
    }
    if let Some(x) = n693 {
        acc = weigh(acc, x, 693);
    }
    if let Some(x) = n694 {
        acc = weigh(acc, x, 694);
    }
    if let Some(x) = n695 {
        acc = weigh(acc, x, 695);
    }
    if let Some(x) = n696 {
        acc = weigh(acc, x, 696);
    }
    if let Some(x) = n697 {
        acc = weigh(acc, x, 697);
    }
    if let Some(x) = n698 {
        acc = weigh(acc, x, 698);
    }
    if let Some(x) = n699 {
        acc = weigh(acc, x, 699);
    }
    if let Some(x) = n616 {
        acc = region7(x, acc);
    }
    acc
}

/// Region 7, node by node.
pub fn region7(n700: u64, mut acc: u64) -> u64 {
    let n700 = Some(n700);
    let n701 = n700.map(|x| op(&x, 701));
    let n702 = n700.and_then(|x| gate(&x));
    let n703 = n702.map(|x| op(&x, 703));
    let n704 = n703.map(|x| op(&x, 704));
    let n705 = n702.zip(n701).map(|(a, b)| merge(&a, &b, 705));
    let n706 = n703.and_then(|x| gate(&x));
    let n707 = n701.and_then(|x| gate(&x));
    let n708 = n704.map(|x| op(&x, 708));
    let n709 = n707.map(|x| op(&x, 709));
    let n710 = n707.map(|x| op(&x, 710));
    let n711 = n702.map(|x| op(&x, 711));
    let n712 = n705.zip(n704).map(|(a, b)| merge(&a, &b, 712));
    let n713 = n711.map(|x| op(&x, 713));
    let n714 = n702.map(|x| op(&x, 714));
    let n715 = n710.zip(n711).map(|(a, b)| merge(&a, &b, 715));
    let n716 = n715.and_then(|x| gate(&x));
    let n717 = n706.map(|x| op(&x, 717));
    let n718 = n715.and_then(|x| gate(&x));
    let n719 = n707.map(|x| op(&x, 719));
    let n720 = n716.map(|x| op(&x, 720));
    let n721 = n709.map(|x| op(&x, 721));
    let n722 = n721.zip(n710).map(|(a, b)| merge(&a, &b, 722));
    let n723 = n719.map(|x| op(&x, 723));
    let n724 = n723.zip(n723).map(|(a, b)| merge(&a, &b, 724));
    let n725 = n723.map(|x| op(&x, 725));
    let n726 = n723.map(|x| op(&x, 726));
    let n727 = n716.map(|x| op(&x, 727));
    let n728 = n727.zip(n726).map(|(a, b)| merge(&a, &b, 728));
    let n729 = n726.map(|x| op(&x, 729));
    let n730 = n714.map(|x| op(&x, 730));
    let n731 = n728.map(|x| op(&x, 731));
    let n732 = n724.map(|x| op(&x, 732));
    let n733 = n719.map(|x| op(&x, 733));
    let n734 = n733.map(|x| op(&x, 734));
    let n735 = n727.and_then(|x| gate(&x));
    let n736 = n728.map(|x| op(&x, 736));
    let n737 = n722.map(|x| op(&x, 737));
    let n738 = n736.zip(n727).map(|(a, b)| merge(&a, &b, 738));
    let n739 = n733.map(|x| op(&x, 739));
    let n740 = n735.map(|x| op(&x, 740));
    let n741 = n729.and_then(|x| gate(&x));
    let n742 = n728.map(|x| op(&x, 742));
    let n743 = n740.map(|x| op(&x, 743));
    let n744 = n740.map(|x| op(&x, 744));
    let n745 = n738.map(|x| op(&x, 745));
    let n746 = n734.map(|x| op(&x, 746));
    let n747 = n738.map(|x| op(&x, 747));
    let n748 = n743.map(|x| op(&x, 748));
    let n749 = n743.and_then(|x| gate(&x));
    let n750 = n742.zip(n736).map(|(a, b)| merge(&a, &b, 750));
    let n751 = n741.and_then(|x| gate(&x));
    let n752 = n743.and_then(|x| gate(&x));
    let n753 = n746.zip(n751).map(|(a, b)| merge(&a, &b, 753));
    let n754 = n750.map(|x| op(&x, 754));
    let n755 = n748.map(|x| op(&x, 755));
    let n756 = n743.map(|x| op(&x, 756));
    let n757 = n744.zip(n745).map(|(a, b)| merge(&a, &b, 757));
    let n758 = n757.zip(n756).map(|(a, b)| merge(&a, &b, 758));
    let n759 = n744.map(|x| op(&x, 759));
    let n760 = n751.map(|x| op(&x, 760));
    let n761 = n749.zip(n759).map(|(a, b)| merge(&a, &b, 761));
    let n762 = n759.map(|x| op(&x, 762));
    let n763 = n755.zip(n748).map(|(a, b)| merge(&a, &b, 763));
    let n764 = n758.and_then(|x| gate(&x));
    let n765 = n756.and_then(|x| gate(&x));
    let n766 = n759.map(|x| op(&x, 766));
    let n767 = n760.map(|x| op(&x, 767));
    let n768 = n758.map(|x| op(&x, 768));
    let n769 = n768.and_then(|x| gate(&x));
    let n770 = n759.map(|x| op(&x, 770));
    let n771 = n770.zip(n756).map(|(a, b)| merge(&a, &b, 771));
    let n772 = n766.zip(n759).map(|(a, b)| merge(&a, &b, 772));
    let n773 = n766.map(|x| op(&x, 773));
    let n774 = n767.and_then(|x| gate(&x));
    let n775 = n765.map(|x| op(&x, 775));
    let n776 = n763.map(|x| op(&x, 776));
    let n777 = n773.map(|x| op(&x, 777));
    let n778 = n772.and_then(|x| gate(&x));
    let n779 = n772.map(|x| op(&x, 779));
    let n780 = n779.map(|x| op(&x, 780));
    let n781 = n776.map(|x| op(&x, 781));
    let n782 = n779.map(|x| op(&x, 782));
    let n783 = n773.map(|x| op(&x, 783));
    let n784 = n773.zip(n777).map(|(a, b)| merge(&a, &b, 784));
    let n785 = n783.and_then(|x| gate(&x));
    let n786 = n777.zip(n773).map(|(a, b)| merge(&a, &b, 786));
    let n787 = n778.and_then(|x| gate(&x));
    let n788 = n777.map(|x| op(&x, 788));
    let n789 = n784.zip(n780).map(|(a, b)| merge(&a, &b, 789));
    let n790 = n782.map(|x| op(&x, 790));
    let n791 = n790.map(|x| op(&x, 791));
    let n792 = n779.map(|x| op(&x, 792));
    let n793 = n780.zip(n785).map(|(a, b)| merge(&a, &b, 793));
    let n794 = n783.map(|x| op(&x, 794));
    let n795 = n782.zip(n788).map(|(a, b)| merge(&a, &b, 795));
    let n796 = n794.map(|x| op(&x, 796));
    let n797 = n783.map(|x| op(&x, 797));
    let n798 = n789.map(|x| op(&x, 798));
    let n799 = n788.map(|x| op(&x, 799));
    if let Some(x) = n708 {
        acc = weigh(acc, x, 708);
    }
    if let Some(x) = n712 {
        acc = weigh(acc, x, 712);
    }
    if let Some(x) = n713 {
        acc = weigh(acc, x, 713);
    }
    if let Some(x) = n717 {
        acc = weigh(acc, x, 717);
    }
    if let Some(x) = n718 {
        acc = weigh(acc, x, 718);
    }
    if let Some(x) = n720 {
        acc = weigh(acc, x, 720);
    }
    if let Some(x) = n725 {
        acc = weigh(acc, x, 725);
    }
    if let Some(x) = n730 {
        acc = weigh(acc, x, 730);
    }
    if let Some(x) = n731 {
        acc = weigh(acc, x, 731);
    }
    if let Some(x) = n732 {
        acc = weigh(acc, x, 732);
    }
    if let Some(x) = n737 {
        acc = weigh(acc, x, 737);
    }
    if let Some(x) = n739 {
        acc = weigh(acc, x, 739);
    }
    if let Some(x) = n747 {
        acc = weigh(acc, x, 747);
    }
    if let Some(x) = n752 {
        acc = weigh(acc, x, 752);
    }
    if let Some(x) = n753 {
        acc = weigh(acc, x, 753);
    }
    if let Some(x) = n754 {
        acc = weigh(acc, x, 754);
    }
    if let Some(x) = n761 {
        acc = weigh(acc, x, 761);
    }
    if let Some(x) = n762 {
        acc = weigh(acc, x, 762);
    }
    if let Some(x) = n764 {
        acc = weigh(acc, x, 764);
    }
    if let Some(x) = n769 {
        acc = weigh(acc, x, 769);
    }
    if let Some(x) = n771 {
        acc = weigh(acc, x, 771);
    }
    if let Some(x) = n774 {
        acc = weigh(acc, x, 774);
    }
    if let Some(x) = n775 {
        acc = weigh(acc, x, 775);
    }
    if let Some(x) = n781 {
        acc = weigh(acc, x, 781);
    }
    if let Some(x) = n786 {
        acc = weigh(acc, x, 786);
    }
    if let Some(x) = n787 {
        acc = weigh(acc, x, 787);
    }
    if let Some(x) = n791 {
        acc = weigh(acc, x, 791);
    }
    if let Some(x) = n792 {
        acc = weigh(acc, x, 792);
    }
    if let Some(x) = n793 {
        acc = weigh(acc, x, 793);
    }
    if let Some(x) = n795 {
        acc = weigh(acc, x, 795);
    }
    if let Some(x) = n796 {
        acc = weigh(acc, x, 796);
    }
    if let Some(x) = n797 {
        acc = weigh(acc, x, 797);
    }
    if let Some(x) = n798 {
        acc = weigh(acc, x, 798);
    }
    if let Some(x) = n799 {
        acc = weigh(acc, x, 799);
    }
    acc
}

/// Region 9, node by node.
pub fn region9(n900: u64, mut acc: u64) -> u64 {
    let n900 = Some(n900);
    let n901 = n900.map(|x| op(&x, 901));
    let n902 = n901.zip(n901).map(|(a, b)| merge(&a, &b, 902));
    let n903 = n902.zip(n902).map(|(a, b)| merge(&a, &b, 903));
    let n904 = n902.zip(n903).map(|(a, b)| merge(&a, &b, 904));
    let n905 = n904.map(|x| op(&x, 905));
    let n906 = n903.map(|x| op(&x, 906));
    let n907 = n901.map(|x| op(&x, 907));
    let n908 = n905.zip(n903).map(|(a, b)| merge(&a, &b, 908));
    let n909 = n903.map(|x| op(&x, 909));
    let n910 = n902.map(|x| op(&x, 910));
    let n911 = n906.zip(n906).map(|(a, b)| merge(&a, &b, 911));
    let n912 = n910.map(|x| op(&x, 912));
    let n913 = n903.zip(n906).map(|(a, b)| merge(&a, &b, 913));
    let n914 = n901.map(|x| op(&x, 914));
    let n915 = n906.map(|x| op(&x, 915));
    let n916 = n912.map(|x| op(&x, 916));
    let n917 = n915.map(|x| op(&x, 917));
    let n918 = n905.and_then(|x| gate(&x));
    let n919 = n904.map(|x| op(&x, 919));
    let n920 = n915.and_then(|x| gate(&x));
    let n921 = n920.zip(n907).map(|(a, b)| merge(&a, &b, 921));
    let n922 = n906.map(|x| op(&x, 922));
    let n923 = n917.map(|x| op(&x, 923));
    let n924 = n922.map(|x| op(&x, 924));
    let n925 = n918.map(|x| op(&x, 925));
    let n926 = n918.zip(n925).map(|(a, b)| merge(&a, &b, 926));
    let n927 = n912.and_then(|x| gate(&x));
    let n928 = n925.zip(n915).map(|(a, b)| merge(&a, &b, 928));
    let n929 = n919.map(|x| op(&x, 929));
    let n930 = n929.zip(n927).map(|(a, b)| merge(&a, &b, 930));
    let n931 = n915.zip(n925).map(|(a, b)| merge(&a, &b, 931));
    let n932 = n930.and_then(|x| gate(&x));
    let n933 = n921.map(|x| op(&x, 933));
    let n934 = n922.zip(n927).map(|(a, b)| merge(&a, &b, 934));
    let n935 = n920.zip(n932).map(|(a, b)| merge(&a, &b, 935));
    let n936 = n929.zip(n929).map(|(a, b)| merge(&a, &b, 936));
    let n937 = n926.and_then(|x| gate(&x));
    let n938 = n928.map(|x| op(&x, 938));
    let n939 = n931.zip(n927).map(|(a, b)| merge(&a, &b, 939));
    let n940 = n936.zip(n924).map(|(a, b)| merge(&a, &b, 940));
    let n941 = n937.and_then(|x| gate(&x));
    let n942 = n932.map(|x| op(&x, 942));
    let n943 = n930.and_then(|x| gate(&x));
    let n944 = n933.and_then(|x| gate(&x));
    let n945 = n936.map(|x| op(&x, 945));
    let n946 = n944.map(|x| op(&x, 946));
    let n947 = n945.map(|x| op(&x, 947));
    let n948 = n939.map(|x| op(&x, 948));
    let n949 = n945.zip(n934).map(|(a, b)| merge(&a, &b, 949));
    let n950 = n948.map(|x| op(&x, 950));
    let n951 = n938.zip(n936).map(|(a, b)| merge(&a, &b, 951));
    let n952 = n939.map(|x| op(&x, 952));
    let n953 = n946.map(|x| op(&x, 953));
    let n954 = n950.zip(n950).map(|(a, b)| merge(&a, &b, 954));
    let n955 = n941.and_then(|x| gate(&x));
    let n956 = n942.zip(n949).map(|(a, b)| merge(&a, &b, 956));
    let n957 = n955.map(|x| op(&x, 957));
    let n958 = n943.and_then(|x| gate(&x));
    let n959 = n951.map(|x| op(&x, 959));
    let n960 = n958.zip(n955).map(|(a, b)| merge(&a, &b, 960));
    let n961 = n955.zip(n959).map(|(a, b)| merge(&a, &b, 961));
    let n962 = n949.map(|x| op(&x, 962));
    let n963 = n958.map(|x| op(&x, 963));
    let n964 = n952.zip(n962).map(|(a, b)| merge(&a, &b, 964));
    let n965 = n957.map(|x| op(&x, 965));
    let n966 = n958.and_then(|x| gate(&x));
    let n967 = n963.map(|x| op(&x, 967));
    let n968 = n952.map(|x| op(&x, 968));
    let n969 = n963.map(|x| op(&x, 969));
    let n970 = n965.zip(n959).map(|(a, b)| merge(&a, &b, 970));
    let n971 = n955.zip(n969).map(|(a, b)| merge(&a, &b, 971));
    let n972 = n963.map(|x| op(&x, 972));
    let n973 = n959.map(|x| op(&x, 973));
    let n974 = n962.zip(n970).map(|(a, b)| merge(&a, &b, 974));
    let n975 = n961.map(|x| op(&x, 975));
    let n976 = n963.map(|x| op(&x, 976));
    let n977 = n965.and_then(|x| gate(&x));
    let n978 = n962.map(|x| op(&x, 978));
    let n979 = n971.and_then(|x| gate(&x));
    let n980 = n968.map(|x| op(&x, 980));
    let n981 = n975.and_then(|x| gate(&x));
    let n982 = n981.zip(n980).map(|(a, b)| merge(&a, &b, 982));
    let n983 = n974.and_then(|x| gate(&x));
    let n984 = n968.map(|x| op(&x, 984));
    let n985 = n977.map(|x| op(&x, 985));
    let n986 = n977.map(|x| op(&x, 986));
    let n987 = n972.map(|x| op(&x, 987));
    let n988 = n985.zip(n972).map(|(a, b)| merge(&a, &b, 988));
    let n989 = n983.map(|x| op(&x, 989));
    let n990 = n980.map(|x| op(&x, 990));
    let n991 = n990.map(|x| op(&x, 991));
    let n992 = n986.and_then(|x| gate(&x));
    let n993 = n977.zip(n984).map(|(a, b)| merge(&a, &b, 993));
    let n994 = n988.map(|x| op(&x, 994));
    let n995 = n992.and_then(|x| gate(&x));
    let n996 = n980.map(|x| op(&x, 996));
    let n997 = n982.zip(n981).map(|(a, b)| merge(&a, &b, 997));
    let n998 = n987.and_then(|x| gate(&x));
    let n999 = n993.and_then(|x| gate(&x));
    if let Some(x) = n908 {
        acc = weigh(acc, x, 908);
    }
    if let Some(x) = n909 {
        acc = weigh(acc, x, 909);
    }
    if let Some(x) = n911 {
        acc = weigh(acc, x, 911);
    }
    if let Some(x) = n913 {
        acc = weigh(acc, x, 913);
    }
    if let Some(x) = n914 {
        acc = weigh(acc, x, 914);
    }
    if let Some(x) = n916 {
        acc = weigh(acc, x, 916);
    }
    if let Some(x) = n923 {
        acc = weigh(acc, x, 923);
    }
    if let Some(x) = n935 {
        acc = weigh(acc, x, 935);
    }
    if let Some(x) = n940 {
        acc = weigh(acc, x, 940);
    }
    if let Some(x) = n947 {
        acc = weigh(acc, x, 947);
    }
    if let Some(x) = n953 {
        acc = weigh(acc, x, 953);
    }
    if let Some(x) = n954 {
        acc = weigh(acc, x, 954);
    }
    if let Some(x) = n956 {
        acc = weigh(acc, x, 956);
    }
    if let Some(x) = n960 {
        acc = weigh(acc, x, 960);
    }
    if let Some(x) = n964 {
        acc = weigh(acc, x, 964);
    }
    if let Some(x) = n966 {
        acc = weigh(acc, x, 966);
    }
    if let Some(x) = n967 {
        acc = weigh(acc, x, 967);
    }
    if let Some(x) = n973 {
        acc = weigh(acc, x, 973);
    }
    if let Some(x) = n976 {
        acc = weigh(acc, x, 976);
    }
    if let Some(x) = n978 {
        acc = weigh(acc, x, 978);
    }
    if let Some(x) = n979 {
        acc = weigh(acc, x, 979);
    }
    if let Some(x) = n989 {
        acc = weigh(acc, x, 989);
    }
    if let Some(x) = n991 {
        acc = weigh(acc, x, 991);
    }
    if let Some(x) = n994 {
        acc = weigh(acc, x, 994);
    }
    if let Some(x) = n995 {
        acc = weigh(acc, x, 995);
    }
    if let Some(x) = n996 {
        acc = weigh(acc, x, 996);
    }
    if let Some(x) = n997 {
        acc = weigh(acc, x, 997);
    }
    if let Some(x) = n998 {
        acc = weigh(acc, x, 998);
    }
    if let Some(x) = n999 {
        acc = weigh(acc, x, 999);
    }
    acc
}

/// Region 0, as control flow.
pub fn clock0(n0: u64, mut acc: u64) -> u64 {
    let mut n1 = 0; let mut c1 = false;
    let mut n4 = 0; let mut c4 = false;
    let mut n6 = 0;
    let mut n7 = 0;
    let mut n8 = 0; let mut c8 = false;
    let mut n12 = 0; let mut c12 = false;
    let mut n13 = 0;
    let mut n14 = 0;
    let mut n15 = 0; let mut c15 = false;
    let mut n16 = 0; let mut c16 = false;
    let mut n17 = 0; let mut c17 = false;
    let mut n18 = 0;
    let mut n20 = 0;
    let mut n21 = 0;
    let mut n25 = 0;
    let mut n26 = 0;
    let mut n27 = 0;
    let mut n28 = 0;
    let mut n29 = 0;
    let mut n30 = 0;
    let mut n31 = 0;
    let mut n33 = 0; let mut c33 = false;
    let mut n34 = 0;
    let mut n35 = 0;
    let mut n37 = 0;
    let mut n38 = 0;
    let mut n39 = 0;
    let mut n41 = 0;
    let mut n42 = 0;
    let mut n43 = 0;
    let mut n44 = 0;
    let mut n45 = 0;
    let mut n46 = 0;
    let mut n47 = 0;
    let mut n49 = 0;
    let mut n50 = 0;
    let mut n51 = 0;
    let mut n53 = 0;
    let mut n54 = 0;
    let mut n55 = 0; let mut c55 = false;
    let mut n56 = 0;
    let mut n57 = 0;
    let mut n58 = 0;
    let mut n59 = 0;
    let mut n60 = 0;
    let mut n61 = 0;
    let mut n62 = 0;
    let mut n63 = 0;
    let mut n64 = 0;
    let mut n65 = 0; let mut c65 = false;
    let mut n66 = 0;
    let mut n67 = 0;
    let mut n68 = 0;
    let mut n69 = 0; let mut c69 = false;
    let mut n70 = 0; let mut c70 = false;
    let mut n71 = 0;
    let mut n72 = 0; let mut c72 = false;
    let mut n73 = 0;
    let mut n74 = 0;
    let mut n75 = 0;
    let mut n76 = 0;
    let mut n77 = 0;
    let mut n78 = 0;
    let mut n79 = 0;
    let mut n80 = 0;
    let mut n81 = 0;
    let mut n82 = 0;
    let mut n83 = 0;
    let mut n84 = 0;
    let mut n85 = 0;
    let mut n86 = 0;
    let mut n87 = 0;
    let mut n88 = 0;
    let mut n89 = 0;
    let mut n90 = 0;
    let mut n91 = 0;
    let mut n92 = 0;
    let mut n93 = 0;
    let mut n94 = 0;
    let mut n95 = 0;
    let mut n96 = 0;
    let mut n97 = 0;
    let mut n98 = 0;
    let mut n99 = 0;
    if let Some(x) = gate(&n0) { n1 = x; c1 = true;  }
    let n2 = op(&n0, 2);
    let n3 = merge(&n0, &n0, 3);
    if let Some(x) = gate(&n3) { n4 = x; c4 = true;  }
    let n5 = op(&n0, 5);
    let n9 = op(&n2, 9);  acc = clock6(n9, acc);
    let n10 = op(&n3, 10);
    let n11 = op(&n0, 11);
    if let Some(x) = gate(&n3) { n12 = x; c12 = true;  }
    let n19 = op(&n3, 19);
    let n22 = op(&n10, 22);
    let n23 = op(&n22, 23); acc = weigh(acc, n23, 23);
    let n24 = op(&n11, 24);
    let n32 = op(&n24, 32);
    let n36 = op(&n32, 36);
    let n40 = op(&n36, 40);
    let n48 = op(&n32, 48);
    let n52 = merge(&n48, &n40, 52); acc = weigh(acc, n52, 52);
    if c4 {
        n6 = op(&n4, 6);
        if let Some(x) = gate(&n6) { n8 = x; c8 = true;  }
        n20 = merge(&n4, &n5, 20);
        n35 = op(&n20, 35);
        n37 = op(&n35, 37);
        n39 = op(&n37, 39); acc = weigh(acc, n39, 39);
        n46 = op(&n35, 46);
        n53 = op(&n37, 53); acc = weigh(acc, n53, 53);
        n59 = op(&n46, 59);
        if c1 {
            n7 = merge(&n4, &n1, 7); acc = weigh(acc, n7, 7);
        }
        if c8 {
            n14 = merge(&n9, &n8, 14);
            if let Some(x) = gate(&n8) { n15 = x; c15 = true; acc = weigh(acc, n15, 15); }
            if let Some(x) = gate(&n8) { n16 = x; c16 = true; acc = weigh(acc, n16, 16); }
            if let Some(x) = gate(&n14) { n17 = x; c17 = true;  }
            n18 = op(&n14, 18);
            n27 = op(&n18, 27);
            n29 = op(&n14, 29);
            n42 = merge(&n27, &n29, 42);
            n47 = merge(&n42, &n46, 47);
            n56 = op(&n42, 56);
            n63 = op(&n56, 63);
            n64 = op(&n63, 64);
            if let Some(x) = gate(&n63) { n69 = x; c69 = true;  }
            n77 = op(&n64, 77);
            if c17 {
                n26 = op(&n17, 26);
                n30 = op(&n26, 30);
                n31 = merge(&n30, &n19, 31);
                if let Some(x) = gate(&n17) { n33 = x; c33 = true;  }
                n34 = op(&n26, 34); acc = weigh(acc, n34, 34);
                n41 = op(&n30, 41);
                n43 = merge(&n31, &n42, 43);
                n44 = op(&n43, 44);  acc = clock4(n44, acc);
                n45 = merge(&n30, &n44, 45); acc = weigh(acc, n45, 45);
                n49 = op(&n43, 49);
                n50 = merge(&n43, &n48, 50); acc = weigh(acc, n50, 50);
                n51 = op(&n44, 51);
                n54 = op(&n41, 54); acc = weigh(acc, n54, 54);
                if let Some(x) = gate(&n41) { n55 = x; c55 = true;  }
                n57 = op(&n44, 57);
                n58 = op(&n44, 58); acc = weigh(acc, n58, 58);
                n60 = merge(&n47, &n49, 60);
                n61 = op(&n57, 61);
                n62 = op(&n51, 62);
                if let Some(x) = gate(&n61) { n65 = x; c65 = true;  }
                if let Some(x) = gate(&n61) { n70 = x; c70 = true;  }
                n75 = merge(&n62, &n60, 75); acc = weigh(acc, n75, 75);
                if c65 {
                    n66 = op(&n65, 66);
                    n67 = merge(&n66, &n62, 67); acc = weigh(acc, n67, 67);
                    n71 = merge(&n65, &n59, 71);
                    n74 = op(&n71, 74);
                    n78 = op(&n71, 78);
                    n80 = op(&n71, 80);
                    n82 = op(&n71, 82);
                    n83 = op(&n82, 83);
                    n85 = op(&n78, 85);
                    n87 = op(&n80, 87);
                    n88 = op(&n74, 88);
                    n90 = op(&n83, 90); acc = weigh(acc, n90, 90);
                    n92 = merge(&n88, &n82, 92);
                    n97 = merge(&n92, &n88, 97); acc = weigh(acc, n97, 97);
                    n99 = op(&n85, 99); acc = weigh(acc, n99, 99);
                }
                if c55 {
                    n68 = op(&n55, 68); acc = weigh(acc, n68, 68);
                }
                if c70 {
                    n73 = op(&n70, 73); acc = weigh(acc, n73, 73);
                    n76 = op(&n70, 76);
                    if c65 {
                        n89 = merge(&n76, &n83, 89);
                        n95 = op(&n89, 95); acc = weigh(acc, n95, 95);
                    }
                }
            }
            if c69 {
                if let Some(x) = gate(&n69) { n72 = x; c72 = true;  }
                n79 = op(&n69, 79);
                n81 = op(&n79, 81);
                n84 = op(&n81, 84);
                n91 = op(&n79, 91); acc = weigh(acc, n91, 91);
                if c72 {
                    n86 = merge(&n72, &n77, 86); acc = weigh(acc, n86, 86);
                }
                if c65 {
                    n93 = merge(&n83, &n84, 93);
                    n94 = merge(&n79, &n85, 94); acc = weigh(acc, n94, 94);
                    n96 = merge(&n93, &n87, 96); acc = weigh(acc, n96, 96);
                    n98 = op(&n93, 98); acc = weigh(acc, n98, 98);
                }
            }
        }
    }
    if c12 {
        n13 = op(&n12, 13); acc = weigh(acc, n13, 13);
        n21 = op(&n12, 21); acc = weigh(acc, n21, 21);
        n25 = op(&n12, 25);
        n28 = op(&n25, 28); acc = weigh(acc, n28, 28);
        if c33 {
            n38 = merge(&n25, &n33, 38); acc = weigh(acc, n38, 38);
        }
    }
    acc
}

/// Region 4, as control flow.
pub fn clock4(n400: u64, mut acc: u64) -> u64 {
    let mut n405 = 0; let mut c405 = false;
    let mut n410 = 0;
    let mut n412 = 0;
    let mut n413 = 0; let mut c413 = false;
    let mut n416 = 0;
    let mut n418 = 0; let mut c418 = false;
    let mut n419 = 0; let mut c419 = false;
    let mut n420 = 0; let mut c420 = false;
    let mut n421 = 0;
    let mut n422 = 0; let mut c422 = false;
    let mut n423 = 0; let mut c423 = false;
    let mut n426 = 0;
    let mut n427 = 0;
    let mut n429 = 0; let mut c429 = false;
    let mut n430 = 0;
    let mut n431 = 0;
    let mut n433 = 0;
    let mut n434 = 0;
    let mut n435 = 0;
    let mut n436 = 0;
    let mut n437 = 0;
    let mut n438 = 0;
    let mut n439 = 0;
    let mut n440 = 0; let mut c440 = false;
    let mut n441 = 0;
    let mut n442 = 0; let mut c442 = false;
    let mut n444 = 0;
    let mut n445 = 0; let mut c445 = false;
    let mut n446 = 0;
    let mut n447 = 0;
    let mut n448 = 0;
    let mut n449 = 0; let mut c449 = false;
    let mut n450 = 0;
    let mut n451 = 0;
    let mut n452 = 0; let mut c452 = false;
    let mut n453 = 0; let mut c453 = false;
    let mut n454 = 0; let mut c454 = false;
    let mut n455 = 0;
    let mut n456 = 0;
    let mut n457 = 0;
    let mut n458 = 0;
    let mut n459 = 0;
    let mut n460 = 0;
    let mut n461 = 0;
    let mut n462 = 0; let mut c462 = false;
    let mut n463 = 0;
    let mut n464 = 0;
    let mut n465 = 0;
    let mut n466 = 0;
    let mut n467 = 0;
    let mut n468 = 0;
    let mut n469 = 0;
    let mut n470 = 0;
    let mut n471 = 0;
    let mut n472 = 0;
    let mut n473 = 0;
    let mut n474 = 0;
    let mut n475 = 0;
    let mut n476 = 0;
    let mut n477 = 0;
    let mut n478 = 0;
    let mut n479 = 0; let mut c479 = false;
    let mut n480 = 0;
    let mut n481 = 0;
    let mut n482 = 0;
    let mut n483 = 0;
    let mut n484 = 0;
    let mut n485 = 0;
    let mut n486 = 0;
    let mut n487 = 0;
    let mut n488 = 0;
    let mut n489 = 0;
    let mut n490 = 0;
    let mut n491 = 0;
    let mut n492 = 0;
    let mut n493 = 0;
    let mut n494 = 0; let mut c494 = false;
    let mut n495 = 0;
    let mut n496 = 0;
    let mut n497 = 0;
    let mut n498 = 0; let mut c498 = false;
    let mut n499 = 0;
    let n401 = op(&n400, 401);
    let n402 = op(&n400, 402);
    let n403 = op(&n400, 403);
    let n404 = merge(&n403, &n403, 404);
    if let Some(x) = gate(&n402) { n405 = x; c405 = true;  }
    let n406 = op(&n400, 406); acc = weigh(acc, n406, 406);
    let n407 = op(&n401, 407); acc = weigh(acc, n407, 407);
    let n408 = op(&n400, 408);
    let n409 = merge(&n401, &n408, 409);
    let n411 = op(&n402, 411);
    if let Some(x) = gate(&n403) { n413 = x; c413 = true; acc = weigh(acc, n413, 413); }
    let n414 = op(&n404, 414);
    let n415 = merge(&n414, &n401, 415);
    let n417 = op(&n403, 417);
    if let Some(x) = gate(&n404) { n418 = x; c418 = true;  }
    if let Some(x) = gate(&n411) { n419 = x; c419 = true;  }
    if let Some(x) = gate(&n409) { n420 = x; c420 = true;  }
    if let Some(x) = gate(&n415) { n423 = x; c423 = true;  }
    let n424 = op(&n414, 424);
    let n425 = op(&n409, 425); acc = weigh(acc, n425, 425);
    let n428 = op(&n424, 428);  acc = clock9(n428, acc);
    if let Some(x) = gate(&n414) { n429 = x; c429 = true;  }
    let n432 = op(&n417, 432);
    let n443 = op(&n428, 443); acc = weigh(acc, n443, 443);
    if c405 {
        n410 = op(&n405, 410);
        n412 = op(&n410, 412);
        n416 = op(&n410, 416);
        n421 = op(&n412, 421);
        n430 = merge(&n421, &n416, 430);
        n439 = op(&n430, 439);
        n444 = op(&n439, 444);
        n446 = op(&n444, 446);
        n447 = op(&n439, 447);
        n448 = op(&n439, 448); acc = weigh(acc, n448, 448);
        if let Some(x) = gate(&n444) { n449 = x; c449 = true; acc = weigh(acc, n449, 449); }
        if let Some(x) = gate(&n444) { n454 = x; c454 = true;  }
        n458 = op(&n446, 458);
        n459 = op(&n447, 459);
        n463 = op(&n458, 463); acc = weigh(acc, n463, 463);
        n469 = op(&n458, 469);
        n471 = op(&n458, 471); acc = weigh(acc, n471, 471);
        n473 = op(&n459, 473);
        n485 = merge(&n473, &n469, 485);
        if c454 {
            n466 = op(&n454, 466);
            n474 = op(&n466, 474); acc = weigh(acc, n474, 474);
        }
    }
    if c418 {
        if let Some(x) = gate(&n418) { n422 = x; c422 = true;  }
        n433 = op(&n418, 433);
        if let Some(x) = gate(&n433) { n442 = x; c442 = true; acc = weigh(acc, n442, 442); }
        if let Some(x) = gate(&n433) { n445 = x; c445 = true;  }
        if c422 {
            n431 = op(&n422, 431); acc = weigh(acc, n431, 431);
            n438 = merge(&n422, &n432, 438);
            if let Some(x) = gate(&n438) { n452 = x; c452 = true;  }
            if let Some(x) = gate(&n438) { n453 = x; c453 = true;  }
            if c405 {
                n434 = merge(&n422, &n421, 434); acc = weigh(acc, n434, 434);
                if c452 {
                    n457 = merge(&n444, &n452, 457); acc = weigh(acc, n457, 457);
                }
            }
            if c453 {
                n455 = op(&n453, 455); acc = weigh(acc, n455, 455);
                n468 = op(&n453, 468);
                n477 = op(&n468, 477); acc = weigh(acc, n477, 477);
            }
            if c452 {
                n464 = op(&n452, 464);
                n470 = op(&n464, 470);
                n480 = op(&n470, 480);
            }
        }
        if c405 {
            n437 = merge(&n421, &n433, 437); acc = weigh(acc, n437, 437);
        }
        if c445 {
            n460 = op(&n445, 460);
        }
    }
    if c419 {
        n426 = op(&n419, 426); acc = weigh(acc, n426, 426);
    }
    if c420 {
        n427 = op(&n420, 427); acc = weigh(acc, n427, 427);
        n435 = op(&n420, 435);
        n451 = op(&n435, 451);
        if let Some(x) = gate(&n451) { n462 = x; c462 = true;  }
        if c423 {
            n436 = merge(&n420, &n423, 436); acc = weigh(acc, n436, 436);
        }
        if c405 {
            n456 = merge(&n451, &n446, 456); acc = weigh(acc, n456, 456);
        }
        if c462 {
            n467 = op(&n462, 467);
            n472 = op(&n462, 472);
            n478 = op(&n462, 478);
            n488 = op(&n478, 488); acc = weigh(acc, n488, 488);
            n492 = op(&n478, 492); acc = weigh(acc, n492, 492);
            if c452 {
                n493 = merge(&n480, &n478, 493); acc = weigh(acc, n493, 493);
            }
        }
        if c445 {
            n461 = merge(&n460, &n451, 461);
            n475 = op(&n461, 475);
            if let Some(x) = gate(&n475) { n479 = x; c479 = true;  }
            if c479 {
                n487 = op(&n479, 487); acc = weigh(acc, n487, 487);
                if let Some(x) = gate(&n479) { n494 = x; c494 = true;  }
                if c462 {
                    n481 = merge(&n479, &n478, 481);
                    n482 = merge(&n472, &n479, 482); acc = weigh(acc, n482, 482);
                    n483 = merge(&n479, &n467, 483);
                    n497 = op(&n483, 497); acc = weigh(acc, n497, 497);
                    if c405 {
                        n484 = merge(&n473, &n481, 484);
                        n489 = merge(&n481, &n484, 489);
                        n495 = op(&n484, 495);
                        if let Some(x) = gate(&n489) { n498 = x; c498 = true; acc = weigh(acc, n498, 498); }
                        n499 = op(&n495, 499); acc = weigh(acc, n499, 499);
                    }
                }
                if c494 {
                    n496 = op(&n494, 496); acc = weigh(acc, n496, 496);
                }
            }
            if c462 {
                n490 = merge(&n478, &n475, 490);
                if c405 {
                    n491 = merge(&n490, &n485, 491); acc = weigh(acc, n491, 491);
                }
            }
        }
    }
    if c429 {
        if let Some(x) = gate(&n429) { n440 = x; c440 = true;  }
        if c420 && c440 {
            n441 = merge(&n435, &n440, 441); acc = weigh(acc, n441, 441);
        }
        if c405 && c440 {
            n450 = merge(&n444, &n440, 450);
            n465 = op(&n450, 465);
            if c462 {
                n476 = merge(&n465, &n472, 476);
                n486 = merge(&n472, &n476, 486); acc = weigh(acc, n486, 486);
            }
        }
    }
    acc
}

/// Region 6, as control flow.
pub fn clock6(n600: u64, mut acc: u64) -> u64 {
    let mut n602 = 0; let mut c602 = false;
    let mut n604 = 0; let mut c604 = false;
    let mut n605 = 0; let mut c605 = false;
    let mut n606 = 0;
    let mut n607 = 0;
    let mut n608 = 0;
    let mut n610 = 0;
    let mut n611 = 0;
    let mut n612 = 0; let mut c612 = false;
    let mut n613 = 0;
    let mut n614 = 0; let mut c614 = false;
    let mut n615 = 0;
    let mut n617 = 0;
    let mut n618 = 0;
    let mut n619 = 0;
    let mut n620 = 0;
    let mut n621 = 0;
    let mut n622 = 0;
    let mut n623 = 0;
    let mut n624 = 0;
    let mut n625 = 0;
    let mut n626 = 0;
    let mut n628 = 0;
    let mut n629 = 0;
    let mut n631 = 0;
    let mut n632 = 0;
    let mut n633 = 0;
    let mut n634 = 0;
    let mut n635 = 0;
    let mut n636 = 0;
    let mut n638 = 0;
    let mut n639 = 0;
    let mut n640 = 0;
    let mut n641 = 0;
    let mut n642 = 0;
    let mut n643 = 0;
    let mut n646 = 0;
    let mut n648 = 0;
    let mut n649 = 0;
    let mut n650 = 0;
    let mut n651 = 0; let mut c651 = false;
    let mut n652 = 0;
    let mut n653 = 0; let mut c653 = false;
    let mut n656 = 0;
    let mut n658 = 0; let mut c658 = false;
    let mut n662 = 0;
    let mut n664 = 0;
    let mut n665 = 0;
    let mut n666 = 0;
    let mut n667 = 0;
    let mut n668 = 0;
    let mut n669 = 0;
    let mut n670 = 0; let mut c670 = false;
    let mut n671 = 0;
    let mut n672 = 0;
    let mut n673 = 0;
    let mut n674 = 0;
    let mut n675 = 0; let mut c675 = false;
    let mut n676 = 0;
    let mut n677 = 0;
    let mut n678 = 0;
    let mut n679 = 0;
    let mut n680 = 0; let mut c680 = false;
    let mut n681 = 0;
    let mut n682 = 0;
    let mut n683 = 0;
    let mut n684 = 0;
    let mut n685 = 0; let mut c685 = false;
    let mut n686 = 0;
    let mut n687 = 0;
    let mut n688 = 0;
    let mut n689 = 0;
    let mut n690 = 0;
    let mut n691 = 0;
    let mut n692 = 0;
    let mut n693 = 0;
    let mut n694 = 0; let mut c694 = false;
    let mut n695 = 0;
    let mut n696 = 0;
    let mut n697 = 0;
    let mut n698 = 0;
    let mut n699 = 0;
    let n601 = op(&n600, 601);
    if let Some(x) = gate(&n601) { n602 = x; c602 = true;  }
    let n603 = op(&n600, 603);
    if let Some(x) = gate(&n600) { n604 = x; c604 = true;  }
    if let Some(x) = gate(&n600) { n605 = x; c605 = true; acc = weigh(acc, n605, 605); }
    let n609 = op(&n600, 609); acc = weigh(acc, n609, 609);
    let n616 = op(&n603, 616);  acc = clock7(n616, acc);
    let n627 = op(&n616, 627);
    let n630 = op(&n616, 630);
    let n637 = merge(&n630, &n627, 637);
    let n644 = op(&n637, 644); acc = weigh(acc, n644, 644);
    let n645 = op(&n630, 645);
    let n647 = op(&n637, 647);
    if let Some(x) = gate(&n637) { n651 = x; c651 = true; acc = weigh(acc, n651, 651); }
    let n654 = op(&n647, 654);
    let n655 = op(&n645, 655); acc = weigh(acc, n655, 655);
    let n657 = op(&n645, 657); acc = weigh(acc, n657, 657);
    let n659 = merge(&n654, &n645, 659);
    let n660 = op(&n647, 660);
    let n661 = op(&n654, 661); acc = weigh(acc, n661, 661);
    let n663 = merge(&n660, &n659, 663);
    if let Some(x) = gate(&n663) { n675 = x; c675 = true;  }
    if c602 {
        n606 = merge(&n602, &n601, 606);
        n607 = merge(&n600, &n602, 607);
        n608 = op(&n602, 608);
        n610 = op(&n608, 610);
        n611 = op(&n608, 611);
        if let Some(x) = gate(&n610) { n612 = x; c612 = true; acc = weigh(acc, n612, 612); }
        n613 = merge(&n600, &n610, 613);
        if let Some(x) = gate(&n613) { n614 = x; c614 = true;  }
        n615 = op(&n606, 615);
        n618 = op(&n615, 618);
        n619 = op(&n610, 619);
        n620 = op(&n608, 620);
        n621 = op(&n619, 621);
        n622 = op(&n611, 622); acc = weigh(acc, n622, 622);
        n623 = merge(&n607, &n613, 623); acc = weigh(acc, n623, 623);
        n625 = op(&n615, 625);
        n626 = merge(&n610, &n625, 626);
        n629 = op(&n618, 629);
        n631 = op(&n618, 631);
        n632 = merge(&n631, &n621, 632);
        n633 = op(&n629, 633); acc = weigh(acc, n633, 633);
        n634 = op(&n620, 634);
        n635 = op(&n629, 635);
        n636 = op(&n629, 636);
        n639 = op(&n635, 639); acc = weigh(acc, n639, 639);
        n640 = merge(&n629, &n632, 640);
        n641 = op(&n625, 641); acc = weigh(acc, n641, 641);
        n642 = op(&n626, 642);
        n643 = merge(&n634, &n631, 643);
        n646 = op(&n642, 646);
        n648 = op(&n634, 648); acc = weigh(acc, n648, 648);
        n649 = op(&n640, 649);
        n650 = merge(&n634, &n636, 650); acc = weigh(acc, n650, 650);
        n652 = merge(&n642, &n647, 652);
        if let Some(x) = gate(&n646) { n653 = x; c653 = true;  }
        n656 = merge(&n652, &n642, 656); acc = weigh(acc, n656, 656);
        if let Some(x) = gate(&n643) { n658 = x; c658 = true;  }
        n665 = op(&n652, 665);
        n668 = merge(&n652, &n663, 668);
        if let Some(x) = gate(&n665) { n670 = x; c670 = true; acc = weigh(acc, n670, 670); }
        n673 = op(&n665, 673);
        n684 = op(&n668, 684); acc = weigh(acc, n684, 684);
        if let Some(x) = gate(&n673) { n685 = x; c685 = true;  }
        if c614 {
            n628 = merge(&n614, &n627, 628);
            n638 = op(&n628, 638); acc = weigh(acc, n638, 638);
        }
        if c658 {
            n662 = merge(&n649, &n658, 662);
            n664 = op(&n662, 664);
            n671 = op(&n662, 671);
            n672 = op(&n671, 672);
            n674 = op(&n664, 674);
            n676 = op(&n672, 676);
            n677 = op(&n676, 677);
            n678 = op(&n676, 678);
            n679 = merge(&n668, &n672, 679);
            n682 = merge(&n674, &n677, 682);
            n686 = op(&n678, 686); acc = weigh(acc, n686, 686);
            n689 = op(&n674, 689); acc = weigh(acc, n689, 689);
            n690 = op(&n679, 690);
            n691 = op(&n677, 691); acc = weigh(acc, n691, 691);
            n692 = merge(&n679, &n690, 692);
            n696 = merge(&n682, &n690, 696); acc = weigh(acc, n696, 696);
            n699 = op(&n692, 699); acc = weigh(acc, n699, 699);
        }
        if c653 {
            n666 = merge(&n659, &n653, 666); acc = weigh(acc, n666, 666);
            n667 = op(&n653, 667); acc = weigh(acc, n667, 667);
            n669 = merge(&n653, &n659, 669);
            n681 = merge(&n669, &n673, 681);
            if let Some(x) = gate(&n681) { n694 = x; c694 = true; acc = weigh(acc, n694, 694); }
            if c658 {
                n688 = merge(&n681, &n678, 688);
                n693 = op(&n688, 693); acc = weigh(acc, n693, 693);
            }
        }
        if c685 {
            n698 = op(&n685, 698); acc = weigh(acc, n698, 698);
        }
    }
    if c604 {
        n617 = op(&n604, 617);
        n624 = op(&n617, 624); acc = weigh(acc, n624, 624);
    }
    if c675 {
        if let Some(x) = gate(&n675) { n680 = x; c680 = true;  }
        n683 = op(&n675, 683);
        n687 = merge(&n675, &n675, 687); acc = weigh(acc, n687, 687);
        n697 = op(&n683, 697); acc = weigh(acc, n697, 697);
        if c680 {
            n695 = op(&n680, 695); acc = weigh(acc, n695, 695);
        }
    }
    acc
}

/// Region 7, as control flow.
pub fn clock7(n700: u64, mut acc: u64) -> u64 {
    let mut n702 = 0; let mut c702 = false;
    let mut n703 = 0;
    let mut n704 = 0;
    let mut n705 = 0;
    let mut n706 = 0; let mut c706 = false;
    let mut n707 = 0; let mut c707 = false;
    let mut n708 = 0;
    let mut n709 = 0;
    let mut n710 = 0;
    let mut n711 = 0;
    let mut n712 = 0;
    let mut n713 = 0;
    let mut n714 = 0;
    let mut n715 = 0;
    let mut n716 = 0; let mut c716 = false;
    let mut n717 = 0;
    let mut n718 = 0; let mut c718 = false;
    let mut n719 = 0;
    let mut n720 = 0;
    let mut n721 = 0;
    let mut n722 = 0;
    let mut n723 = 0;
    let mut n724 = 0;
    let mut n725 = 0;
    let mut n726 = 0;
    let mut n727 = 0;
    let mut n728 = 0;
    let mut n729 = 0;
    let mut n730 = 0;
    let mut n731 = 0;
    let mut n732 = 0;
    let mut n733 = 0;
    let mut n734 = 0;
    let mut n735 = 0; let mut c735 = false;
    let mut n736 = 0;
    let mut n737 = 0;
    let mut n738 = 0;
    let mut n739 = 0;
    let mut n740 = 0;
    let mut n741 = 0; let mut c741 = false;
    let mut n742 = 0;
    let mut n743 = 0;
    let mut n744 = 0;
    let mut n745 = 0;
    let mut n746 = 0;
    let mut n747 = 0;
    let mut n748 = 0;
    let mut n749 = 0; let mut c749 = false;
    let mut n750 = 0;
    let mut n751 = 0; let mut c751 = false;
    let mut n752 = 0; let mut c752 = false;
    let mut n753 = 0;
    let mut n754 = 0;
    let mut n755 = 0;
    let mut n756 = 0;
    let mut n757 = 0;
    let mut n758 = 0;
    let mut n759 = 0;
    let mut n760 = 0;
    let mut n761 = 0;
    let mut n762 = 0;
    let mut n763 = 0;
    let mut n764 = 0; let mut c764 = false;
    let mut n765 = 0; let mut c765 = false;
    let mut n766 = 0;
    let mut n767 = 0;
    let mut n768 = 0;
    let mut n769 = 0; let mut c769 = false;
    let mut n770 = 0;
    let mut n771 = 0;
    let mut n772 = 0;
    let mut n773 = 0;
    let mut n774 = 0; let mut c774 = false;
    let mut n775 = 0;
    let mut n776 = 0;
    let mut n777 = 0;
    let mut n778 = 0; let mut c778 = false;
    let mut n779 = 0;
    let mut n780 = 0;
    let mut n781 = 0;
    let mut n782 = 0;
    let mut n783 = 0;
    let mut n784 = 0;
    let mut n785 = 0; let mut c785 = false;
    let mut n786 = 0;
    let mut n787 = 0; let mut c787 = false;
    let mut n788 = 0;
    let mut n789 = 0;
    let mut n790 = 0;
    let mut n791 = 0;
    let mut n792 = 0;
    let mut n793 = 0;
    let mut n794 = 0;
    let mut n795 = 0;
    let mut n796 = 0;
    let mut n797 = 0;
    let mut n798 = 0;
    let mut n799 = 0;
    let n701 = op(&n700, 701);
    if let Some(x) = gate(&n700) { n702 = x; c702 = true;  }
    if let Some(x) = gate(&n701) { n707 = x; c707 = true;  }
    if c702 {
        n703 = op(&n702, 703);
        n704 = op(&n703, 704);
        n705 = merge(&n702, &n701, 705);
        if let Some(x) = gate(&n703) { n706 = x; c706 = true;  }
        n708 = op(&n704, 708); acc = weigh(acc, n708, 708);
        n711 = op(&n702, 711);
        n712 = merge(&n705, &n704, 712); acc = weigh(acc, n712, 712);
        n713 = op(&n711, 713); acc = weigh(acc, n713, 713);
        n714 = op(&n702, 714);
        n730 = op(&n714, 730); acc = weigh(acc, n730, 730);
        if c706 {
            n717 = op(&n706, 717); acc = weigh(acc, n717, 717);
        }
    }
    if c707 {
        n709 = op(&n707, 709);
        n710 = op(&n707, 710);
        n719 = op(&n707, 719);
        n721 = op(&n709, 721);
        n722 = merge(&n721, &n710, 722);
        n723 = op(&n719, 723);
        n724 = merge(&n723, &n723, 724);
        n725 = op(&n723, 725); acc = weigh(acc, n725, 725);
        n726 = op(&n723, 726);
        n729 = op(&n726, 729);
        n732 = op(&n724, 732); acc = weigh(acc, n732, 732);
        n733 = op(&n719, 733);
        n734 = op(&n733, 734);
        n737 = op(&n722, 737); acc = weigh(acc, n737, 737);
        n739 = op(&n733, 739); acc = weigh(acc, n739, 739);
        if let Some(x) = gate(&n729) { n741 = x; c741 = true;  }
        n746 = op(&n734, 746);
        if c702 {
            n715 = merge(&n710, &n711, 715);
            if let Some(x) = gate(&n715) { n716 = x; c716 = true;  }
            if let Some(x) = gate(&n715) { n718 = x; c718 = true; acc = weigh(acc, n718, 718); }
            if c716 {
                n720 = op(&n716, 720); acc = weigh(acc, n720, 720);
                n727 = op(&n716, 727);
                n728 = merge(&n727, &n726, 728);
                n731 = op(&n728, 731); acc = weigh(acc, n731, 731);
                if let Some(x) = gate(&n727) { n735 = x; c735 = true;  }
                n736 = op(&n728, 736);
                n738 = merge(&n736, &n727, 738);
                n742 = op(&n728, 742);
                n745 = op(&n738, 745);
                n747 = op(&n738, 747); acc = weigh(acc, n747, 747);
                n750 = merge(&n742, &n736, 750);
                n754 = op(&n750, 754); acc = weigh(acc, n754, 754);
                if c735 {
                    n740 = op(&n735, 740);
                    n743 = op(&n740, 743);
                    n744 = op(&n740, 744);
                    n748 = op(&n743, 748);
                    if let Some(x) = gate(&n743) { n749 = x; c749 = true;  }
                    if let Some(x) = gate(&n743) { n752 = x; c752 = true; acc = weigh(acc, n752, 752); }
                    n755 = op(&n748, 755);
                    n756 = op(&n743, 756);
                    n757 = merge(&n744, &n745, 757);
                    n758 = merge(&n757, &n756, 758);
                    n759 = op(&n744, 759);
                    n762 = op(&n759, 762); acc = weigh(acc, n762, 762);
                    n763 = merge(&n755, &n748, 763);
                    if let Some(x) = gate(&n758) { n764 = x; c764 = true; acc = weigh(acc, n764, 764); }
                    if let Some(x) = gate(&n756) { n765 = x; c765 = true;  }
                    n766 = op(&n759, 766);
                    n768 = op(&n758, 768);
                    if let Some(x) = gate(&n768) { n769 = x; c769 = true; acc = weigh(acc, n769, 769); }
                    n770 = op(&n759, 770);
                    n771 = merge(&n770, &n756, 771); acc = weigh(acc, n771, 771);
                    n772 = merge(&n766, &n759, 772);
                    n773 = op(&n766, 773);
                    n776 = op(&n763, 776);
                    n777 = op(&n773, 777);
                    if let Some(x) = gate(&n772) { n778 = x; c778 = true;  }
                    n779 = op(&n772, 779);
                    n780 = op(&n779, 780);
                    n781 = op(&n776, 781); acc = weigh(acc, n781, 781);
                    n782 = op(&n779, 782);
                    n783 = op(&n773, 783);
                    n784 = merge(&n773, &n777, 784);
                    if let Some(x) = gate(&n783) { n785 = x; c785 = true;  }
                    n786 = merge(&n777, &n773, 786); acc = weigh(acc, n786, 786);
                    n788 = op(&n777, 788);
                    n789 = merge(&n784, &n780, 789);
                    n790 = op(&n782, 790);
                    n791 = op(&n790, 791); acc = weigh(acc, n791, 791);
                    n792 = op(&n779, 792); acc = weigh(acc, n792, 792);
                    n794 = op(&n783, 794);
                    n795 = merge(&n782, &n788, 795); acc = weigh(acc, n795, 795);
                    n796 = op(&n794, 796); acc = weigh(acc, n796, 796);
                    n797 = op(&n783, 797); acc = weigh(acc, n797, 797);
                    n798 = op(&n789, 798); acc = weigh(acc, n798, 798);
                    n799 = op(&n788, 799); acc = weigh(acc, n799, 799);
                    if c749 {
                        n761 = merge(&n749, &n759, 761); acc = weigh(acc, n761, 761);
                    }
                    if c765 {
                        n775 = op(&n765, 775); acc = weigh(acc, n775, 775);
                    }
                    if c778 {
                        if let Some(x) = gate(&n778) { n787 = x; c787 = true; acc = weigh(acc, n787, 787); }
                    }
                    if c785 {
                        n793 = merge(&n780, &n785, 793); acc = weigh(acc, n793, 793);
                    }
                }
            }
        }
        if c741 {
            if let Some(x) = gate(&n741) { n751 = x; c751 = true;  }
            if c751 {
                n753 = merge(&n746, &n751, 753); acc = weigh(acc, n753, 753);
                n760 = op(&n751, 760);
                n767 = op(&n760, 767);
                if let Some(x) = gate(&n767) { n774 = x; c774 = true; acc = weigh(acc, n774, 774); }
            }
        }
    }
    acc
}

/// Region 9, as control flow.
pub fn clock9(n900: u64, mut acc: u64) -> u64 {
    let mut n918 = 0; let mut c918 = false;
    let mut n920 = 0; let mut c920 = false;
    let mut n921 = 0;
    let mut n925 = 0;
    let mut n926 = 0;
    let mut n927 = 0; let mut c927 = false;
    let mut n928 = 0;
    let mut n930 = 0;
    let mut n931 = 0;
    let mut n932 = 0; let mut c932 = false;
    let mut n933 = 0;
    let mut n934 = 0;
    let mut n935 = 0;
    let mut n937 = 0; let mut c937 = false;
    let mut n938 = 0;
    let mut n939 = 0;
    let mut n941 = 0; let mut c941 = false;
    let mut n942 = 0;
    let mut n943 = 0; let mut c943 = false;
    let mut n944 = 0; let mut c944 = false;
    let mut n946 = 0;
    let mut n948 = 0;
    let mut n949 = 0;
    let mut n950 = 0;
    let mut n951 = 0;
    let mut n952 = 0;
    let mut n953 = 0;
    let mut n954 = 0;
    let mut n955 = 0; let mut c955 = false;
    let mut n956 = 0;
    let mut n957 = 0;
    let mut n958 = 0; let mut c958 = false;
    let mut n959 = 0;
    let mut n960 = 0;
    let mut n961 = 0;
    let mut n962 = 0;
    let mut n963 = 0;
    let mut n964 = 0;
    let mut n965 = 0;
    let mut n966 = 0; let mut c966 = false;
    let mut n967 = 0;
    let mut n968 = 0;
    let mut n969 = 0;
    let mut n970 = 0;
    let mut n971 = 0;
    let mut n972 = 0;
    let mut n973 = 0;
    let mut n974 = 0;
    let mut n975 = 0;
    let mut n976 = 0;
    let mut n977 = 0; let mut c977 = false;
    let mut n978 = 0;
    let mut n979 = 0; let mut c979 = false;
    let mut n980 = 0;
    let mut n981 = 0; let mut c981 = false;
    let mut n982 = 0;
    let mut n983 = 0; let mut c983 = false;
    let mut n984 = 0;
    let mut n985 = 0;
    let mut n986 = 0;
    let mut n987 = 0;
    let mut n988 = 0;
    let mut n989 = 0;
    let mut n990 = 0;
    let mut n991 = 0;
    let mut n992 = 0; let mut c992 = false;
    let mut n993 = 0;
    let mut n994 = 0;
    let mut n995 = 0; let mut c995 = false;
    let mut n996 = 0;
    let mut n997 = 0;
    let mut n998 = 0; let mut c998 = false;
    let mut n999 = 0; let mut c999 = false;
    let n901 = op(&n900, 901);
    let n902 = merge(&n901, &n901, 902);
    let n903 = merge(&n902, &n902, 903);
    let n904 = merge(&n902, &n903, 904);
    let n905 = op(&n904, 905);
    let n906 = op(&n903, 906);
    let n907 = op(&n901, 907);
    let n908 = merge(&n905, &n903, 908); acc = weigh(acc, n908, 908);
    let n909 = op(&n903, 909); acc = weigh(acc, n909, 909);
    let n910 = op(&n902, 910);
    let n911 = merge(&n906, &n906, 911); acc = weigh(acc, n911, 911);
    let n912 = op(&n910, 912);
    let n913 = merge(&n903, &n906, 913); acc = weigh(acc, n913, 913);
    let n914 = op(&n901, 914); acc = weigh(acc, n914, 914);
    let n915 = op(&n906, 915);
    let n916 = op(&n912, 916); acc = weigh(acc, n916, 916);
    let n917 = op(&n915, 917);
    if let Some(x) = gate(&n905) { n918 = x; c918 = true;  }
    let n919 = op(&n904, 919);
    if let Some(x) = gate(&n915) { n920 = x; c920 = true;  }
    let n922 = op(&n906, 922);
    let n923 = op(&n917, 923); acc = weigh(acc, n923, 923);
    let n924 = op(&n922, 924);
    if let Some(x) = gate(&n912) { n927 = x; c927 = true;  }
    let n929 = op(&n919, 929);
    let n936 = merge(&n929, &n929, 936);
    let n940 = merge(&n936, &n924, 940); acc = weigh(acc, n940, 940);
    let n945 = op(&n936, 945);
    let n947 = op(&n945, 947); acc = weigh(acc, n947, 947);
    if c920 {
        n921 = merge(&n920, &n907, 921);
        n933 = op(&n921, 933);
        if let Some(x) = gate(&n933) { n944 = x; c944 = true;  }
        if c944 {
            n946 = op(&n944, 946);
            n953 = op(&n946, 953); acc = weigh(acc, n953, 953);
        }
    }
    if c918 {
        n925 = op(&n918, 925);
        n926 = merge(&n918, &n925, 926);
        n928 = merge(&n925, &n915, 928);
        n931 = merge(&n915, &n925, 931);
        if let Some(x) = gate(&n926) { n937 = x; c937 = true;  }
        n938 = op(&n928, 938);
        n951 = merge(&n938, &n936, 951);
        n959 = op(&n951, 959);
        n973 = op(&n959, 973); acc = weigh(acc, n973, 973);
        if c927 {
            n939 = merge(&n931, &n927, 939);
            n948 = op(&n939, 948);
            n950 = op(&n948, 950);
            n952 = op(&n939, 952);
            n954 = merge(&n950, &n950, 954); acc = weigh(acc, n954, 954);
            n968 = op(&n952, 968);
            n980 = op(&n968, 980);
            n984 = op(&n968, 984);
            n990 = op(&n980, 990);
            n991 = op(&n990, 991); acc = weigh(acc, n991, 991);
            n996 = op(&n980, 996); acc = weigh(acc, n996, 996);
        }
        if c937 {
            if let Some(x) = gate(&n937) { n941 = x; c941 = true;  }
            if c941 {
                if let Some(x) = gate(&n941) { n955 = x; c955 = true;  }
                if c955 {
                    n957 = op(&n955, 957);
                    n961 = merge(&n955, &n959, 961);
                    n965 = op(&n957, 965);
                    n970 = merge(&n965, &n959, 970);
                    n975 = op(&n961, 975);
                    if let Some(x) = gate(&n965) { n977 = x; c977 = true;  }
                    if let Some(x) = gate(&n975) { n981 = x; c981 = true;  }
                    if c977 {
                        n985 = op(&n977, 985);
                        n986 = op(&n977, 986);
                        if let Some(x) = gate(&n986) { n992 = x; c992 = true;  }
                        if c927 {
                            n993 = merge(&n977, &n984, 993);
                            if let Some(x) = gate(&n993) { n999 = x; c999 = true; acc = weigh(acc, n999, 999); }
                        }
                        if c992 {
                            if let Some(x) = gate(&n992) { n995 = x; c995 = true; acc = weigh(acc, n995, 995); }
                        }
                    }
                    if c927 && c981 {
                        n982 = merge(&n981, &n980, 982);
                        n997 = merge(&n982, &n981, 997); acc = weigh(acc, n997, 997);
                    }
                }
            }
        }
    }
    if c927 {
        n930 = merge(&n929, &n927, 930);
        if let Some(x) = gate(&n930) { n932 = x; c932 = true;  }
        n934 = merge(&n922, &n927, 934);
        if let Some(x) = gate(&n930) { n943 = x; c943 = true;  }
        n949 = merge(&n945, &n934, 949);
        n962 = op(&n949, 962);
        n978 = op(&n962, 978); acc = weigh(acc, n978, 978);
        if c932 {
            n942 = op(&n932, 942);
            n956 = merge(&n942, &n949, 956); acc = weigh(acc, n956, 956);
            if c920 {
                n935 = merge(&n920, &n932, 935); acc = weigh(acc, n935, 935);
            }
        }
        if c943 {
            if let Some(x) = gate(&n943) { n958 = x; c958 = true;  }
            if c958 {
                n963 = op(&n958, 963);
                if let Some(x) = gate(&n958) { n966 = x; c966 = true; acc = weigh(acc, n966, 966); }
                n967 = op(&n963, 967); acc = weigh(acc, n967, 967);
                n969 = op(&n963, 969);
                n972 = op(&n963, 972);
                n976 = op(&n963, 976); acc = weigh(acc, n976, 976);
                n987 = op(&n972, 987);
                if let Some(x) = gate(&n987) { n998 = x; c998 = true; acc = weigh(acc, n998, 998); }
                if c955 {
                    n960 = merge(&n958, &n955, 960); acc = weigh(acc, n960, 960);
                    n971 = merge(&n955, &n969, 971);
                    if let Some(x) = gate(&n971) { n979 = x; c979 = true; acc = weigh(acc, n979, 979); }
                    if c977 {
                        n988 = merge(&n985, &n972, 988);
                        n994 = op(&n988, 994); acc = weigh(acc, n994, 994);
                    }
                }
            }
        }
        if c918 {
            n964 = merge(&n952, &n962, 964); acc = weigh(acc, n964, 964);
            if c955 {
                n974 = merge(&n962, &n970, 974);
                if let Some(x) = gate(&n974) { n983 = x; c983 = true;  }
                if c983 {
                    n989 = op(&n983, 989); acc = weigh(acc, n989, 989);
                }
            }
        }
    }
    acc
}

/// Sum of all sinks.
pub fn checksum(graph: &Mixed1000) -> u64 {
    let n = graph.nodes();
    [
        n.s7.sum(),
        n.s13.sum(),
        n.s15.sum(),
        n.s16.sum(),
        n.s21.sum(),
        n.s23.sum(),
        n.s28.sum(),
        n.s34.sum(),
        n.s38.sum(),
        n.s39.sum(),
        n.s45.sum(),
        n.s50.sum(),
        n.s52.sum(),
        n.s53.sum(),
        n.s54.sum(),
        n.s58.sum(),
        n.s67.sum(),
        n.s68.sum(),
        n.s73.sum(),
        n.s75.sum(),
        n.s86.sum(),
        n.s90.sum(),
        n.s91.sum(),
        n.s94.sum(),
        n.s95.sum(),
        n.s96.sum(),
        n.s97.sum(),
        n.s98.sum(),
        n.s99.sum(),
        n.s102.sum(),
        n.s108.sum(),
        n.s109.sum(),
        n.s113.sum(),
        n.s123.sum(),
        n.s127.sum(),
        n.s133.sum(),
        n.s135.sum(),
        n.s136.sum(),
        n.s137.sum(),
        n.s140.sum(),
        n.s143.sum(),
        n.s150.sum(),
        n.s151.sum(),
        n.s154.sum(),
        n.s161.sum(),
        n.s165.sum(),
        n.s168.sum(),
        n.s183.sum(),
        n.s186.sum(),
        n.s187.sum(),
        n.s190.sum(),
        n.s192.sum(),
        n.s193.sum(),
        n.s195.sum(),
        n.s196.sum(),
        n.s197.sum(),
        n.s198.sum(),
        n.s199.sum(),
        n.s207.sum(),
        n.s210.sum(),
        n.s218.sum(),
        n.s221.sum(),
        n.s227.sum(),
        n.s228.sum(),
        n.s229.sum(),
        n.s231.sum(),
        n.s233.sum(),
        n.s237.sum(),
        n.s238.sum(),
        n.s244.sum(),
        n.s247.sum(),
        n.s248.sum(),
        n.s249.sum(),
        n.s250.sum(),
        n.s251.sum(),
        n.s252.sum(),
        n.s258.sum(),
        n.s262.sum(),
        n.s263.sum(),
        n.s267.sum(),
        n.s268.sum(),
        n.s274.sum(),
        n.s275.sum(),
        n.s280.sum(),
        n.s281.sum(),
        n.s288.sum(),
        n.s289.sum(),
        n.s291.sum(),
        n.s293.sum(),
        n.s295.sum(),
        n.s296.sum(),
        n.s297.sum(),
        n.s298.sum(),
        n.s299.sum(),
        n.s301.sum(),
        n.s306.sum(),
        n.s309.sum(),
        n.s311.sum(),
        n.s313.sum(),
        n.s315.sum(),
        n.s327.sum(),
        n.s332.sum(),
        n.s341.sum(),
        n.s345.sum(),
        n.s348.sum(),
        n.s349.sum(),
        n.s355.sum(),
        n.s356.sum(),
        n.s359.sum(),
        n.s370.sum(),
        n.s371.sum(),
        n.s382.sum(),
        n.s386.sum(),
        n.s387.sum(),
        n.s389.sum(),
        n.s392.sum(),
        n.s393.sum(),
        n.s394.sum(),
        n.s395.sum(),
        n.s396.sum(),
        n.s397.sum(),
        n.s398.sum(),
        n.s399.sum(),
        n.s406.sum(),
        n.s407.sum(),
        n.s413.sum(),
        n.s425.sum(),
        n.s426.sum(),
        n.s427.sum(),
        n.s431.sum(),
        n.s434.sum(),
        n.s436.sum(),
        n.s437.sum(),
        n.s441.sum(),
        n.s442.sum(),
        n.s443.sum(),
        n.s448.sum(),
        n.s449.sum(),
        n.s455.sum(),
        n.s456.sum(),
        n.s457.sum(),
        n.s463.sum(),
        n.s471.sum(),
        n.s474.sum(),
        n.s477.sum(),
        n.s482.sum(),
        n.s486.sum(),
        n.s487.sum(),
        n.s488.sum(),
        n.s491.sum(),
        n.s492.sum(),
        n.s493.sum(),
        n.s496.sum(),
        n.s497.sum(),
        n.s498.sum(),
        n.s499.sum(),
        n.s512.sum(),
        n.s516.sum(),
        n.s520.sum(),
        n.s525.sum(),
        n.s529.sum(),
        n.s531.sum(),
        n.s535.sum(),
        n.s536.sum(),
        n.s539.sum(),
        n.s543.sum(),
        n.s545.sum(),
        n.s546.sum(),
        n.s551.sum(),
        n.s553.sum(),
        n.s554.sum(),
        n.s556.sum(),
        n.s563.sum(),
        n.s565.sum(),
        n.s574.sum(),
        n.s575.sum(),
        n.s576.sum(),
        n.s579.sum(),
        n.s581.sum(),
        n.s582.sum(),
        n.s592.sum(),
        n.s594.sum(),
        n.s595.sum(),
        n.s596.sum(),
        n.s597.sum(),
        n.s598.sum(),
        n.s599.sum(),
        n.s605.sum(),
        n.s609.sum(),
        n.s612.sum(),
        n.s622.sum(),
        n.s623.sum(),
        n.s624.sum(),
        n.s633.sum(),
        n.s638.sum(),
        n.s639.sum(),
        n.s641.sum(),
        n.s644.sum(),
        n.s648.sum(),
        n.s650.sum(),
        n.s651.sum(),
        n.s655.sum(),
        n.s656.sum(),
        n.s657.sum(),
        n.s661.sum(),
        n.s666.sum(),
        n.s667.sum(),
        n.s670.sum(),
        n.s684.sum(),
        n.s686.sum(),
        n.s687.sum(),
        n.s689.sum(),
        n.s691.sum(),
        n.s693.sum(),
        n.s694.sum(),
        n.s695.sum(),
        n.s696.sum(),
        n.s697.sum(),
        n.s698.sum(),
        n.s699.sum(),
        n.s708.sum(),
        n.s712.sum(),
        n.s713.sum(),
        n.s717.sum(),
        n.s718.sum(),
        n.s720.sum(),
        n.s725.sum(),
        n.s730.sum(),
        n.s731.sum(),
        n.s732.sum(),
        n.s737.sum(),
        n.s739.sum(),
        n.s747.sum(),
        n.s752.sum(),
        n.s753.sum(),
        n.s754.sum(),
        n.s761.sum(),
        n.s762.sum(),
        n.s764.sum(),
        n.s769.sum(),
        n.s771.sum(),
        n.s774.sum(),
        n.s775.sum(),
        n.s781.sum(),
        n.s786.sum(),
        n.s787.sum(),
        n.s791.sum(),
        n.s792.sum(),
        n.s793.sum(),
        n.s795.sum(),
        n.s796.sum(),
        n.s797.sum(),
        n.s798.sum(),
        n.s799.sum(),
        n.s805.sum(),
        n.s811.sum(),
        n.s812.sum(),
        n.s814.sum(),
        n.s819.sum(),
        n.s824.sum(),
        n.s826.sum(),
        n.s830.sum(),
        n.s833.sum(),
        n.s834.sum(),
        n.s836.sum(),
        n.s838.sum(),
        n.s844.sum(),
        n.s845.sum(),
        n.s847.sum(),
        n.s853.sum(),
        n.s855.sum(),
        n.s856.sum(),
        n.s857.sum(),
        n.s862.sum(),
        n.s864.sum(),
        n.s868.sum(),
        n.s871.sum(),
        n.s875.sum(),
        n.s876.sum(),
        n.s880.sum(),
        n.s881.sum(),
        n.s887.sum(),
        n.s888.sum(),
        n.s891.sum(),
        n.s894.sum(),
        n.s895.sum(),
        n.s896.sum(),
        n.s897.sum(),
        n.s898.sum(),
        n.s899.sum(),
        n.s908.sum(),
        n.s909.sum(),
        n.s911.sum(),
        n.s913.sum(),
        n.s914.sum(),
        n.s916.sum(),
        n.s923.sum(),
        n.s935.sum(),
        n.s940.sum(),
        n.s947.sum(),
        n.s953.sum(),
        n.s954.sum(),
        n.s956.sum(),
        n.s960.sum(),
        n.s964.sum(),
        n.s966.sum(),
        n.s967.sum(),
        n.s973.sum(),
        n.s976.sum(),
        n.s978.sum(),
        n.s979.sum(),
        n.s989.sum(),
        n.s991.sum(),
        n.s994.sum(),
        n.s995.sum(),
        n.s996.sum(),
        n.s997.sum(),
        n.s998.sum(),
        n.s999.sum(),
    ]
    .into_iter()
    .fold(0, u64::wrapping_add)
}

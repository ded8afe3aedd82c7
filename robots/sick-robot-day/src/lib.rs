//! The robot of the SICK Robot Day 2014, which fetches labelled cubes and delivers them (thesis chapter 4): the arena
//! in simulation, and the robot's perception, measured in it.

mod arena;
mod eyes;
mod hopper;
pub mod measure;

mod nodes;
mod signs;

pub use arena::{Arena, ISLAND_SIDE, NUMBER_HEIGHT, Station, TARGET_HEIGHT, WALL_HEIGHT};
pub use eyes::{Eyes, LASER, View, camera, hall_light};
pub use hopper::{CUBE_SIDE, Cube, HOPPER_SIZE, Hopper};
pub use nodes::{CUBE, NUMBERS, NumberSign, NumberSigns, clearest, cube_number, is_cube, number_sign, sign_target};
pub use signs::{NUMBER_WIDTH, TARGET_WIDTH};

/// The compiled perception.
pub mod programs {
    pub use {
        cross::FindCross,
        cube::{CubeByDeviation, CubeByNetwork},
        number::CubeNumber,
        signs::FindSign,
        target::FindTarget,
    };

    mod cross {
        apex_rt::graph!("cross.afg");
    }

    mod cube {
        apex_rt::graph!("cube.afg");
    }

    mod number {
        apex_rt::graph!("number.afg");
    }

    mod signs {
        apex_rt::graph!("signs.afg");
    }

    mod target {
        apex_rt::graph!("target.afg");
    }
}

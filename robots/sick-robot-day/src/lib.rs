//! The robot of the SICK Robot Day 2014, which fetches labelled cubes and delivers them (thesis chapter 4): a
//! simulation of the arena, the robot's perception and mission, their evaluation, and the report of a run.

mod arena;
pub mod bench;
pub mod contest;
mod hopper;
mod knowledge_log;
pub mod measure;
mod nodes;
mod places;
pub mod run;
pub mod run_report;
mod sensors;
mod signs;

pub use arena::{Arena, ISLAND_SIDE, NUMBER_HEIGHT, Station, TARGET_HEIGHT, WALL_HEIGHT};
pub use hopper::{CUBE_SIDE, Cube, HOPPER_SIZE, Hopper};
pub use knowledge_log::KnowledgeLog;
pub use nodes::{
    CUBE, NUMBERS, NumberSign, NumberSigns, clearest, cube_number, is_cube, number_sign, on_paper, sign_number,
    sign_target,
};
pub use places::{BorderTour, ChooseStation, is_word, origin};
pub use sensors::{LASER, Sensors, View, camera, hall_light};
pub use signs::{NUMBER_WIDTH, TARGET_WIDTH};

/// Compiled graphs.
pub mod programs {
    pub use {
        competition::{Competition, CompetitionParts, SdfCompetition, SdfCompetitionParts},
        cross::FindCross,
        cube::{CubeByDeviation, CubeByNetwork},
        number::CubeNumber,
        signs::FindSign,
        target::FindTarget,
    };

    mod competition {
        apex_macros::graph!("competition.afg");
    }

    #[cfg(test)]
    mod contestant {
        apex_macros::graph!("contestant.afg");
    }

    mod cross {
        apex_macros::graph!("cross.afg");
    }

    mod cube {
        apex_macros::graph!("cube.afg");
    }

    mod number {
        apex_macros::graph!("number.afg");
    }

    mod signs {
        apex_macros::graph!("signs.afg");
    }

    mod target {
        apex_macros::graph!("target.afg");
    }
}

//! The robot of the SICK Robot Day 2014, which fetches labelled cubes and delivers them (thesis chapter 4). The modules
//! here are the robot; [`world`] has the simulated competition with the robot's drivers there, and [`experiments`] its
//! runs, their reports, and what is measured.

pub mod experiments;
mod nodes;
mod places;
mod sensors;
pub mod world;

pub use nodes::{
    CUBE, NUMBERS, NumberSign, NumberSigns, clearest, cube_number, is_cube, number_sign, on_paper, placed, sign_number,
    sign_pose, sign_target,
};
pub use places::{BorderTour, ChooseStation, is_word, origin};
pub use sensors::{LASER, camera};

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

/// Text that `--help` prints.
pub const HELP: &str = "\
The robot of the SICK Robot Day 2014, in simulation: it fetches cubes and takes them to the stations that they name.

Usage: sick-robot-day [compete] [--seed N] [--mission afg|sdf] [--minutes M] [--fault KIND@FROM..UNTIL]...
                      [--keeps-twist] [--out FOLDER] [--film FILE] [--record FILE [--record-images]]
       sick-robot-day bench [--first-seed N] [--seeds N] [--jobs N] [--mission afg|sdf] [--minutes M]
                      [--keeps-twist] [--faults] [--outages] [--times]
       sick-robot-day perception [--seeds N] [--out FOLDER]

`compete`, which is meant if nothing is named, plays a competition against three rivals. It shows it on a terminal, and
leaves a table of what the robot did and pictures: its map, its phases, and what its camera saw.

  --seed N        which hall: its walls, its light, the cubes, the rivals (default 1)
  --mission KIND  what decides: afg, an activity flow graph (default), or sdf, a state machine
  --minutes M     how long it lasts (default 10)
  --fault FAULT   breaks something for a while, as in laser-frozen@100s..103s; may be said several times. There are
                  laser-frozen, camera-black, camera-torn, beams-nan, beams-infinite, beams-zero, beams-missing,
                  odometry-stopped, laser-repeated, rear-frozen, odometry-silent, odometry-nan
  --keeps-twist   motors without a command time-out: they keep the last twist until the next one
  --out FOLDER    a new or empty folder for the pictures (default out/sick-robot-day; if it is not empty,
                  out/sick-robot-day-2, and so on)
  --film FILE     a moving picture of the run, as SVG, which browsers play; a file that is there is replaced
  --record FILE   records what the sensors send, and the poses, maps and speeds of the robot, as MCAP: 9 MB a minute.
                  A file that is there is not overwritten: the next one is FILE-2
  --record-images with the images of the cameras: 220 MB a minute

`bench` plays one competition for each of many seeds, and says how they went.

  --first-seed N  the first seed (default 1)
  --seeds N       how many seeds (default 20; of `perception` 50)
  --jobs N        how many competitions at once (default: as many as there are cores); the table does not depend on it,
                  but for the computing times
  --faults        each of them also with each kind of fault, at a time that the seed draws
  --outages       sensors fail one after the other, at times that the seed draws, and the motors keep the last twist: how
                  long the robot moves without them, and whether that is longer than it promises
  --times         where the time goes, by part of the robot; one competition after the other

`perception` measures how well the robot finds targets, reads number signs and sees cubes, on rendered images; --out is
for pictures of what was seen with seed 1.

Examples:
  sick-robot-day --seed 7 --minutes 3
  sick-robot-day --minutes 3 --film film.svg
  sick-robot-day --mission sdf --fault camera-black@60s..70s --record dark.mcap
  sick-robot-day bench --seeds 8 --faults

Exit codes: 0 fine; 1 in a competition something failed in the robot, it caused a collision, or it took a cube to another
station; 2 it could not be done.
";

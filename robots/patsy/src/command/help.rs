/// Text that `--help` prints, except for `obstacles`.
pub const HELP: &str = "\
PATSY looks for containers in laser scans and draws what it sees.

Usage: patsy [--log FILE [--container pallet|cart] [--labels FILE] [--table FILE]]
       patsy obstacles [OPTIONS]
       patsy accuracy [--first-seed N] [--seeds N] [--jobs N] [--out FILE]
       patsy approach [--first-seed N] [--seeds N] [--jobs N] [--out FILE]
       patsy missions [--first-seed N] [--seeds N] [--jobs N] [--minutes N] [--people N] [--fault KIND | --faults]
                      [--outages] [--keeps-twist] [--world kind|harder|FILE] [--prices]
                      [--out FILE] [--record FILE] [--timeline FILE]
       patsy times [--first-seed N] [--seeds N]
       patsy validate --with FILE --labels FILE --without FILE [--folds N] [--jobs N]

Without arguments it plays 5000 scans in simulated rooms and measures itself. Pictures are written to out/patsy.

  --log FILE        scans from a recording: .csv (number, source number, ranges in m) or CARMEN .log, also packed (.gz)
  --container KIND  what to look for in a recording: pallet (default) or cart
  --labels FILE     boxes that the containers lie in: number, x_min, y_min, x_max, y_max in m
  --table FILE      where the detections are written (default out/patsy/detections.csv)
  --help            this text

`obstacles` measures the detection of obstacles with a time-of-flight camera; `patsy obstacles --help` lists its
options.

`accuracy` measures the errors of the pose of a container by its distance, in the scan alone and with a time-of-flight
camera, and draws them into out/patsy/accuracy.svg. It places a cart and chooses the errors of the camera and the noise
by each seed (default: seeds 1 to 200).

`approach` drives tractor and trailer beneath a container from 459 poses, with the controller of the thesis and with the
planned one, and draws from where they arrive.

  --first-seed N    first seed (default 1): of the directions of the castors, of rooms, motions and noise
  --seeds N         number of seeds (default 1)
  --jobs N          number of threads (default: as many as there are cores)
  --out FILE        the picture (default out/patsy/approach.svg)

`missions` runs the vehicle in a simulated clinic, where it carries containers among people, and counts what it
delivered and touched. It draws the first run.

  --minutes N       simulated time of each run (default 10)
  --people N        number of people (default 8)
  --faults          also runs with a fault of each kind: of the camera, the scanner, the odometry, the lift
  --fault KIND      each run has a fault of this kind, at a time that the seed draws: camera-black, camera-frozen,
                    camera-nan, scanner-frozen, odometry-stopped, lift-jammed
  --outages         instead, sensors fail one after the other, at times that the seed draws, and the motors keep the last
                    twist: how long the vehicle moves without them, and whether that is longer than it promises
  --world WORLD     conditions in the clinic: kind (default), harder, or those of a file; robots/patsy/harder.toml is an
                    example, which describes each value
  --prices          also runs in the world (default: harder), and with each of its values alone, the others kind: the
                    price of each
  --keeps-twist     motors without a command time-out: they keep the last twist until the next one
  --out FILE        the picture (default out/patsy/clinic.svg)
  --record FILE     recording of the first run, for `apex replay` and viewers
  --timeline FILE   what happened in the first run, and when: active nodes, containers set down, bumps

`times` measures the computing time of the search in simulated rooms, on one thread.

`validate` chooses the limits of the search for pallets on all blocks of time of a recording but one, counts what it
finds in that block, and does so for each block.

  --with FILE       scans with a pallet each, whose boxes are in the file of --labels
  --without FILE    scans without a pallet
  --folds N         number of blocks (default 5)

Exit codes: 0 fine, 1 some scans could not be read, 2 nothing could be done.
";

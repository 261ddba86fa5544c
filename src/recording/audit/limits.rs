//! Every number on which a decision of the audit turns, with what it means.
//! It decides nothing itself; limits that also serve to repair or to read a recording (headings across north, fill values) are defined there.

// --- Single values ---

/// Half-width, in rows, of the running median that a single value is compared with.
pub const MEDIAN_ROWS: usize = 3;
/// A value is far from its neighbours at this many standard deviations of how values differ from their neighbours in the run
/// (Hampel's test)
pub const FAR: f64 = 10.0;
/// and at this share of the range of the channel's other values, since data without noise have no scatter.
pub const FAR_SHARE: f64 = 0.1;
/// At the ends of a run, where there are neighbours on one side only, and the ship may begin to turn: this share of the range.
pub const FAR_SHARE_AT_ENDS: f64 = 0.4;
/// A propeller, a rudder or a wind may change for one sample and change back: there a single value is damaged where it is outside the
/// range of the others by this share of that range.
pub const OUTSIDE_SHARE: f64 = 0.5;
/// So many values may be far from their neighbours, or this share of all: where there are more they are no single values.
pub const FEW: usize = 3;
/// See [`FEW`].
pub const FEW_SHARE: f64 = 0.01;
/// The same where no other value is this share as far: those that are far are no tail of what the channel does.
pub const APART_SHARE: f64 = 0.5;
/// See [`APART_SHARE`].
pub const FEW_SHARE_APART: f64 = 0.05;
/// A rudder or a propeller that is 0 for one row was lost where the values before and after differ by at most this share.
pub const LOST_SAME: f64 = 0.5;
/// A rudder that is off by less \[rad\], 1 deg, in one row moves no ship: so much is noise and rounding of a rudder at rest.
pub const RUDDER_BLIP: f64 = 1.0 * std::f64::consts::PI / 180.0;
/// A step that goes on from one beside it, to the same side and at most so many times as far, is no leap to a single value.
pub const GOES_ON: f64 = 3.0;
/// A heading that is off by less \[rad\], 0.5 deg, in one row is noise, or a digit of a compass whose other rows agree to the last one.
pub const HEADING_BLIP: f64 = 0.5 * std::f64::consts::PI / 180.0;
/// A speed that is off by less in one row is a digit of a log of 0.1 kn \[m/s\],
pub const SPEED_BLIP: f64 = 0.0515;
/// or this share of the speed of a model or a small craft.
pub const SPEED_BLIP_SHARE: f64 = 0.05;
/// A rudder up to this angle \[rad\], 45 deg, at an end of a run is one on its way over: runs are cut where an order is given.
pub const RUDDER_OVER: f64 = 45.0 * std::f64::consts::PI / 180.0;
/// Windows from which the scatter at the ends of a run is estimated; of longer runs every n-th is taken.
pub const END_WINDOWS: usize = 2000;
/// Share of the values on each side that does not count for the range of the others.
pub const TAIL: f64 = 0.02;

/// A fill value is separated from all other values of its channel by this many times their range,
pub const FILL_APART: f64 = 3.0;
/// and is there at least so often, unless it is one that programs are known to write.
pub const FILL_ROWS: usize = 2;
/// Different fill values that are looked for in one channel.
pub const FILL_KINDS: usize = 4;

// --- Fixes ---

/// Between two fixes the ship would sail this many times as fast as it does at its fastest,
pub const FIX_SPEED: f64 = 3.0;
/// and the step differs from what velocity and heading say by this many standard deviations of how steps do in the run.
pub const FIX_FAR: f64 = 10.0;
/// A fix or a time stamp is off where the steps before and after miss what velocity and heading say by as much to either side: each by
/// this share of what is sailed in a step at the ship's fastest.
pub const FIX_SHARE: f64 = 0.25;
/// As much to either side: the two together leave at most this share of the smaller one.
pub const FIX_OPPOSITE: f64 = 0.5;
/// Share of the recorded speeds that its fastest is above.
pub const FASTEST: f64 = 0.95;
/// Changes before and after, from which the resolution of positions is estimated: it may change with their digits.
pub const RESOLUTION_CHANGES: usize = 12;
/// Steps below this many resolutions are rounding.
pub const RESOLUTIONS: f64 = 2.0;

// --- Frozen channels ---

/// Fewest rows of one value that are called frozen: of position and heading, which integrate, or of next to nothing; and of velocities.
pub const FROZEN_ROWS: [usize; 2] = [10, 50];
/// A frozen position or heading misses this many times what it changes from value to value around,
pub const FROZEN_CHANGES: f64 = 5.0;
/// and this many times what channel and integral differ by over as many rows elsewhere: a coarse compass differs by its steps.
pub const FROZEN_DIFFERENCES: f64 = 2.0;
/// Share of the stretches elsewhere that differ by less.
pub const FROZEN_SELDOM: f64 = 0.95;
/// A frozen velocity lasts this many spans of the local fits,
pub const FROZEN_SPANS: f64 = 3.0;
/// while position and heading show a velocity that changes by this share of its whole range.
pub const FROZEN_RANGE: f64 = 0.3;
/// and by this share of the speed, or of the yaw rate: on a straight course a velocity does stay constant.
pub const FROZEN_LEVEL: f64 = 0.05;

// --- Repeated values ---

/// Fewest rows of one value that count as a repeated value.
pub const HELD_ROWS: usize = 3;
/// By chance a value is repeated for so long in one of so many studies, by how often values repeat elsewhere and by the resolution.
pub const HELD_CHANCE: f64 = 300.0;
/// The smallest change is the step of a sensor if all changes below this many times its size are its multiples,
pub const HELD_CHANGES: f64 = 20.0;
/// to this share of it: a sensor's step is written with few decimals.
pub const HELD_SAME: f64 = 0.05;
/// Most decimals of a written value.
pub const HELD_DIGITS: i32 = 9;
/// Changes before and after a repeated value that show how the channel moves there.
pub const HELD_BESIDE: usize = 6;
/// Changes below this share of the usual ones of the run are those of a ship at rest: HSVA's KVLCC2 is kept on its course for 27 to 32
/// rows before it is released.
pub const HELD_REST: f64 = 0.2;
/// A channel that changes by fewer of its steps before or after may stand still as it turns: that model's heading does for 16 rows.
pub const HELD_STEPS: f64 = 10.0;
/// Elsewhere at most this share of the rows may repeat a value, in the run and in all runs. Recordings of models in basins, written to
/// three or four digits (KVLCC2 of MARIN and of HSVA), repeat more than that near the ends of their swings.
pub const HELD_SELDOM: f64 = 0.01;
/// A rudder or a propeller whose log stood still leaps from that value by this many times the largest change just before it.
pub const HELD_LEAP: f64 = 3.0;
/// Rows in which the channel must move in the run.
pub const HELD_ROWS_MOVING: usize = 30;

// --- Units, signs, axes ---

/// A rudder that stays below this angle \[rad\], 1.6 deg, may be in radians and read as degrees,
pub const SMALL_RUDDER: f64 = 1.6 * std::f64::consts::PI / 180.0;
/// if the heading changes by more than this many of its largest angles: a ship that is steered straight yaws by a few.
pub const SMALL_RUDDER_TURNS: f64 = 30.0;
/// A propeller below this rate \[1/s\], 3 rpm, may be in rps and read as rpm.
pub const SMALL_RATE: f64 = 0.05;
/// How far a gain may be from a known one to be taken for it: noise in what is compared pulls gains towards zero.
pub const SAME_GAIN: f64 = 0.12;
/// Coherence above which two channels show the same motion, so that their gain means something.
pub const COHERENT: f64 = 0.9;
/// Heading and integrated yaw rate of a run that differ by this, root mean square, do not show one motion \[rad\], 3 deg: noise of a gyro
/// and of a compass stays below.
pub const APART: f64 = 3.0 * std::f64::consts::PI / 180.0;
/// Gains further than this from 1 are worth a look.
pub const CALIBRATED: f64 = 0.1;
/// No calibration is off by this many times, nor its reciprocal: it is a unit.
pub const NO_CALIBRATION: f64 = 20.0;
/// Track and velocity along the earth's axes: coherence of the velocity that is not turned by the heading at least this,
pub const UNTURNED: f64 = 0.97;
/// and of the one that is turned at most this.
pub const TURNED: f64 = 0.9;
/// A mirrored track: coherence with the mirror image at least this,
pub const MIRRORED: f64 = 0.95;
/// without mirroring at most this,
pub const NOT_MIRRORED: f64 = 0.98;
/// and what the mirror image leaves at most this share of what the track itself leaves.
pub const MIRROR_LEAVES: f64 = 0.25;
/// Angle between track and velocity \[deg\] from which the ship moves against its velocity, from which the axes are wrong, and from
/// which a heading may be offset.
pub const TRACK_ANGLES: [f64; 3] = [170.0, 60.0, 3.0];
/// Ratio and angle of track and velocity are off where they are beyond their limits by this many standard errors: a study has tens of
/// runs, and of short ones the error is itself known to a third.
pub const TRACK_ERRORS: f64 = 4.0;
/// Sway of the wrong sign: with the sign turned it leaves less than this share of what is left without,
pub const SWAY_LEAVES: f64 = 0.3;
/// at a coherence below this.
pub const SWAY_COHERENCE: f64 = -0.8;
/// A lever arm between position and velocity: slide in turns at least this share of the sway.
pub const LEVER_SHARE: f64 = 0.2;
/// where the heading turns as fast as the yaw rate says, but for this share,
pub const LEVER_TURN: f64 = 0.5;
/// and at most this share of the ship's length: no antenna stands farther from midship.
pub const LEVER_LONGEST: f64 = 0.75;

// --- Propeller and speed ---

/// Advance ratios u / (n D) that ships under way have, from heavy towing to wind from astern. Open-water diagrams of the Wageningen B
/// series reach zero thrust between 0.6 and 1.5, by pitch.
pub const SAILED: [f64; 2] = [0.2, 1.6];
/// A propeller that turns slower than this share of its fastest in the run is stopped, and has no advance ratio.
pub const POWERED: f64 = 0.05;
/// Samples ahead under power from which a ratio is estimated.
pub const RATIO_SAMPLES: usize = 20;
/// A ship is under way at this many times the speed below which its dynamics are regularised.
pub const UNDER_WAY: f64 = 10.0;
/// A wrong unit brings the ratio back into this part of the range of [`SAILED`]: so many times its smallest, this share of its
/// largest.
pub const RATIO_INSIDE: [f64; 2] = [2.0, 0.8];
/// One run in another unit: its ratio is this many times that of the other runs, or this share of it.
pub const RATIO_APART: f64 = 3.5;

// --- Orders ---

/// A rudder that turns by more than this in a ship length sailed \[deg\] is no steering gear: ships have 30 to 100 (2.3 deg/s at 14 to
/// 40 s a length), and so have their models,
pub const ORDERED_DEGREES: f64 = 500.0;
/// where it turns by more than this from one row to the next \[deg\]: a smaller step is a fast sampling of a gear that starts at once.
pub const ORDERED_LEAP: f64 = 5.0;

// --- Gear ---

/// The limit of a gear is shown where so many runs
pub const GEAR_RUNS: usize = 3;
/// reach this share of the fastest change of all,
pub const GEAR_REACHED: f64 = 0.9;
/// and a run leaps where it is faster than that by this factor. It is no estimate: gear has one limit, and a channel that is recorded with
/// noise reaches it to a few percent.
pub const GEAR_BEYOND: f64 = 1.25;
/// Longest time between two rows that are one step, in usual steps.
pub const GEAR_STEP: f64 = 1.5;
/// A leap that counts is more than this share of the largest value of the channel.
pub const GEAR_SHARE: f64 = 0.05;

// --- Clocks ---

/// Steps from which a lag between two channels that show one motion is worth a note, and a warning.
pub const LAG_STEPS: [f64; 2] = [1.5, 5.0];
/// A lag of a channel of the motion, or of rudder and propeller, is worth a warning from this share of the time in which
/// the ship sails its length; shorter ones are those of steering gear, engines and filters.
pub const LAG_SHARE: f64 = 0.25;
/// A position of another point of the ship than the velocity's is early or late by up to this share of that time: bow and stern are half a
/// length from midship.
pub const LEVER_LAG: f64 = 0.5;
/// Twice the log-likelihood ratio over the residuals, in terms of independent samples, from which a lag is reported: of some tens of
/// lags the best is taken, and gusts are not independent. Of 1280 sound runs (32 concealed cases without an
/// effect, seeds 901 to 916) 8 had such a lag at 10.
pub const LAG_EVIDENCE: f64 = 20.0;
/// The same for the sign of an actuator, whose effect must also explain the response. It stops a fit, so that it must be beyond doubt:
/// at 8 it was reported for 3 of these runs, in which a slow ship was turned by gusts.
pub const SIGN_EVIDENCE: f64 = 25.0;
/// A run in which an actuator acts to the other side, or later, than in the others: the squares that this explains, over those that it
/// leaves an independent sample,
pub const POOLED_EVIDENCE: f64 = 15.0;
/// the same for a lag that is also the best by the coefficients of the run itself, so that one is tried and not some tens: of 3680 sound runs
/// (92 concealed cases of four hulls, seeds 7711 to 7721) none had one,
pub const POOLED_AGREED: f64 = 10.0;
/// and at most this share of the squares is left. Of 1094 sound runs (27 concealed cases, seeds 8101 to 8129, and one of 14 runs) the least
/// share for a lag of two rows or more was 0.44, and for the other side 0.83.
pub const POOLED_LEAVES: f64 = 0.4;
/// Evidence with which a run shows by itself that a channel acts to the other side, two standard errors: else the other runs do not say so.
pub const OWN_SIDE: f64 = 4.0;
/// A channel that is less than this share, squared and by window, of what it is in the run in which it moves most rests, but for rounding.
pub const POOLED_STILL: f64 = 1e-9;
/// Runs in which a channel is this many times as large, squared and by window, as in the middle one do not count among the others.
pub const POOLED_SIZE: f64 = 5.0;
/// A unit or a sign, or whether the motion answers at all, is tested in a run of which the others' coefficients leave at least this many
/// times what they usually leave. Of 3501 sound runs (96 concealed cases, seeds 8601 to 8624, and the three studies) none that shows nothing
/// of its rudder by itself was explained better without it, with evidence of 15 or more, and left 1.5 times as much as usual.
pub const POOLED_UNUSUAL: f64 = 2.5;
/// A rudder or a propeller that keeps one value is compared with the other runs where so many windows are in the stretch and outside it,
pub const STUCK_WINDOWS: usize = 10;
/// and is stuck where it explains nothing ([`EXPLAINS`]) and the others' coefficients leave this many times as much, squared and by window,
/// as they do usually and outside it. In 168 concealed cases (seeds 8801 to 8842) and KVLCC2 at MARIN and HSVA no sound stretch met both; one
/// in a hard turn left 16 times as much, and the rudder explained two thirds. At Esso Osaka two recordings that go on after their trial are
/// reported: one of a ship that is turned about with rudder and propeller at 0, one of a ship that is stopped within 4 s with its propeller at 0.
pub const STUCK_UNLIKE: f64 = 15.0;
/// A channel in another unit, or of another sign, than in the other runs: undone it leaves at most this share of the squares,
pub const SCALE_LEAVES: f64 = 0.25;
/// and twice the log-likelihood ratio is at least this: every run, channel and unit is tested.
pub const SCALE_EVIDENCE: f64 = 40.0;
/// A run in which the channel is this many times as large, squared and by row, as in the middle one does not count: less is a turn with
/// the rudder hard over among runs on a course.
pub const SCALE_SIZE: f64 = 30.0;
/// A factor between units is that of the best proportion to what the other runs say, but for this share,
pub const SCALE_SAME: f64 = 0.25;
/// and the cosine of the two is at least this: a current also makes a ship sway more.
pub const SCALE_COHERENCE: f64 = 0.7;
/// Velocities of all runs but one scatter alike: by at most this factor from the middle one. Scatter of 120 rows is known to 8 %.
pub const SCATTER_ALIKE: f64 = 1.4;
/// The scatter of that one is the factor between two units, to this factor.
pub const SCATTER_SAME: f64 = 1.25;
/// Fewest runs from which the coefficients of the others can be estimated.
pub const POOLED_RUNS: usize = 6;
/// A lag of all runs together is that of a single one if it differs by at most this share.
pub const SAME_LAG: f64 = 0.5;
/// With the lag the response is explained so much better that at most this share of the squares is left, by its own coefficients and by
/// those of the other runs: of the sound runs above none has such a lag by both.
pub const LAG_LEAVES: f64 = 0.7;
/// What an actuator explains of the response at all: with it at most this share of the squares is left, else it is no evidence.
pub const EXPLAINS: f64 = 0.7;
/// Clocks of two sessions, or of one run and the others, differ where the lag of a channel does by this share of the time in which the ship
/// sails its length; so do a channel and the motion in all runs, where nothing else explains it.
pub const SESSION_SHARE: f64 = 0.1;
/// Longest lag looked for, as a share of the run, and in seconds.
pub const LAG_LONGEST: (f64, f64) = (0.125, 60.0);
/// Fewest steps of the window over which a response is integrated; it lasts half the span of the local fits.
pub const RESPONSE_STEPS: usize = 4;
/// Equations of a track, two a row, from which dead reckoning is compared with that of the other runs.
pub const RECKONED_ROWS: f64 = 60.0;
/// Dead reckoning of a run is unusual where it leaves this many times the mean square of the middle run,
pub const RECKONED_UNUSUAL: f64 = 4.0;
/// and the sway is of another sign or unit where undoing that leaves at most this share of it: of these 1080 sound runs (see
/// [`POOLED_LEAVES`]) those that are unusual kept 0.27 or more,
pub const RECKONED_LEAVES: f64 = 0.2;
/// and where twice the log-likelihood ratio is this.
pub const RECKONED_EVIDENCE: f64 = 15.0;
/// A track parts from dead reckoning where it leaves this many times the mean square of the middle run: of those sound runs 12 at most.
pub const RECKONED_UNLIKE: f64 = 25.0;
/// and this share of the ship's length, root mean square: recordings without noise differ by how they are integrated.
pub const RECKONED_LENGTH: f64 = 0.05;
/// A ship whose propeller stands still loses speed: one that sails more lengths than the first and has at least the second share of its speed
/// left is driven. A full tanker coasts its length for a loss of a twentieth.
pub const KEEPS_SPEED: (f64, f64) = (4.0, 0.9);
/// A propeller of the wrong sign: it turns astern in at least this share of the rows,
pub const ASTERN_SHARE: f64 = 0.9;
/// and in the last third of them the ship still sails ahead at this share of its speed in the first.
pub const ASTERN_SPEED: f64 = 0.5;
/// A rudder that stays below this angle \[rad\], 0.1 deg, was never moved.
pub const STILL_RUDDER: f64 = 0.1 * std::f64::consts::PI / 180.0;
/// A steady turn with or against the rudder: cosine of rudder and yaw rate beyond this,
pub const AGAINST: f64 = -0.8;
/// over at least this change of heading \[rad\]
pub const AGAINST_TURN: f64 = std::f64::consts::FRAC_PI_2;
/// and with at least this rudder, root mean square \[rad\].
pub const AGAINST_RUDDER: f64 = 0.05;

// --- Length ---

/// Recordings, all but one of one length, among which a shorter one may have been cut.
pub const LENGTH_RUNS: usize = 6;

// --- Train and test ---

/// Rows that two runs share, bit by bit and in motion, from which they are one recording,
pub const SHARED_ROWS: usize = 20;
/// and share of the shorter one: simulated runs may have an approach in common.
pub const SHARED_SHARE: f64 = 0.1;

/// Rounding that two logs of one motion may differ by: of angles \[rad\], of which logs have tenths of a degree,
pub const COPY_ANGLE: f64 = 0.01;
/// and of speeds, as a share of that at which a Froude number is 1, and of yaw rates in the time that belongs to it: a ship of 100 m 0.03 m/s
/// and 0.02 deg/s, of which logs have a tenth of a knot and of a degree a minute.
pub const COPY_SPEED: f64 = 1e-3;
/// Share of the rows of the shorter run that agree at one distance where one is a copy. A row of five rounded values agrees by chance in
/// neither of two trials with noise; half of the rows of a copy do not agree, where a value lies on the edge between two roundings.
pub const COPY_SHARE: f64 = 0.3;
/// Rows with the same values that are kept for the comparison.
pub const COPY_OWNERS: usize = 8;

// --- Jumps that last ---

/// Samples on each side of a jump that distinguish it from motion.
pub const SIDE: usize = 4;
/// Samples from which the scatter of steps can be estimated.
pub const ENOUGH: usize = 100;
/// A jump is this many standard deviations of what noise and manoeuvres make of steps.
pub const BEYOND_NOISE: f64 = 8.0;
/// A jump would take this many times the acceleration of the ship's own turns, `U^2 / L`, within one sample period.
pub const BEYOND_FORCE: f64 = 2.0;
/// A receiver that repeated its value catches up by at least this share of what the ship sailed meanwhile.
pub const CAUGHT_UP: f64 = 0.75;

// --- Derivatives ---

/// Steps in the shortest span of the local fits that differentiate a channel, their longest span \[s\], and the span as a share of the
/// run.
pub const SPAN: (f64, f64, f64) = (8.0, 60.0, 0.01);

// --- Lags of two series of one motion ---

/// Longest lag looked for, in steps.
pub const PAIR_STEPS: usize = 100;
/// At its best lag the difference is at most this share of the motion squared,
pub const PAIR_LEAVES: f64 = 0.2;
/// and, unless that lag is 0, at most this share of the difference without a lag: noise alone also has a least shift.
pub const PAIR_HALVES: f64 = 0.5;

//! The words that ships and loggers write for what they record, in the languages of those who build them.
//! How a name is read with them is in `names`; whether a column is what its name says is checked against its values elsewhere.

use crate::recording::Channel::*;
use crate::recording::import::signals::log::Meaning::{self, *};

/// Phrases by what they name, parted by commas, in lower case and without accents. A phrase of one letter must begin the name.
pub const PHRASES: &[(Meaning, &str)] = &[
    (Latitude, "lat, latitude, breite, breddegrad, breedtegraad, latitudine, latitud"),
    (Longitude, "lon, lng, long, longitude, lange, laenge, lengdegrad, lengtegraad, longitudine, longitud"),
    (
        VelocityNorth,
        "v north, vn, velocity north, north velocity, speed north, north speed, vel n, vel north, n velocity, n vel, v n",
    ),
    (
        VelocityEast,
        "v east, ve, velocity east, east velocity, speed east, east speed, vel e, vel east, e velocity, e vel, v e",
    ),
    (
        Channel(UWater),
        "u water, stw, stw long, stw longitudinal, speed through water, speed through the water, speed in \
         water, water speed, water speed ahead, long water speed, longitudinal water speed, log speed, speed \
         log, fdw, fahrt durchs wasser, fahrt durch wasser, vitesse surface, velocita in acqua, velocidad en \
         el agua, velocidad en agua, fart gjennom vann, fart gjennom vannet, fart genom vatten, fart genom vattnet, fart \
         gennem vand, fart gennem vandet, snelheid door het water, speed w, spd w, speed tw, em log, doppler log, v log",
    ),
    (
        Channel(VWater),
        "v water, stw trans, stw transverse, stw transversal, stw lateral, stw lat, water speed across, trans \
         water speed, transverse water speed, lateral water speed",
    ),
    (Channel(BankStarboard), "bank starboard"),
    (Channel(BankPort), "bank port"),
    (Channel(Thruster), "bow thruster, thruster, bugstrahler, bugstrahlruder, propulseur etrave"),
    (
        Channel(Delta),
        "rudder, rudder angle, rud, ruder, ruderlage, ruderwinkel, ror, rorvinkel, roerhoek, roer, \
         rudderangle, rsa, barre, angle de barre, angle barre, safran, angle de safran, gouvernail, \
         timone, angolo timone, angolo di timone, angolo del timone, timon, angulo timon, angulo de timon, \
         angulo del timon, angulo de pala",
    ),
    (
        Channel(R),
        "rot, rate of turn, turn rate, yaw rate, yawrate, yaw velocity, yaw speed, yaw vel, heading rate, \
         angular velocity, angular velocity z, gyro z, drehrate, drehgeschwindigkeit, wendegeschwindigkeit, \
         svinghastighet, draaisnelheid, taux de giration, vitesse de giration, taux de rotation, velocita di \
         accostata, velocita accostata, velocidad de giro, regimen de giro, tasa de giro",
    ),
    (
        Course,
        "cog, course, course over ground, track made good, course made good, kurs uber grund, kurs ueber \
         grund, kug, ku g, kurs over grunn, grondkoers, route fond, route sur le fond, rotta, rotta al suolo, rotta \
         vera, rotta sul fondo, rumbo sobre el fondo, rumbo sobre fondo, rumbo efectivo, derrota",
    ),
    (
        GroundSpeed,
        "sog, speed over ground, ground speed, groundspeed, speed g, spd g, speed og, spd og, v gps, gps speed, speed gps, gnss speed, speed gnss, speed made good, fahrt uber grund, \
         fahrt ueber grund, fug, fu g, fart over grunn, vitesse fond, vitesse sur le fond, velocita al suolo, \
         velocita sul fondo, velocidad sobre el fondo, velocidad sobre fondo",
    ),
    (
        Channel(Psi),
        "heading, hdg, hdt, hdm, gyro, psi, yaw, compass, head, steuerkurs, kurs rechtweisend, kurs rw, rw kurs, kurs missweisend, mw kurs, cap, cap vrai, \
         cap magnetique, gyrocompass, gyro compass, kreiselkompass, girobussola, prua, prora, angolo di prua, rumbo, rumbo verdadero, rumbo magnetico",
    ),
    (
        Channel(N),
        "rpm, rps, nps, revs, rev, revolutions, revolution, drehzahl, motordrehzahl, propellerdrehzahl, wellendrehzahl, \
         turtall, toerental, shaft speed, shaft rate, propeller rate, propeller speed, prop speed, propeller \
         rotation, engine speed, tours, tours helice, tours par minute, regime, regime helice, regime moteur, \
         vitesse helice, giri, giri elica, giri motore, revoluciones, revoluciones helice, revoluciones por \
         minuto, vueltas helice",
    ),
    // A pose of ROS counts x to the east and y to the north (REP 103).
    (Channel(X), "northing, x0, pos x, position x, pos north, pose position y"),
    (Channel(Y), "easting, y0, pos y, position y, pos east, pose position x"),
    (Channel(U), "surge velocity, surge speed, surge vel, u, longitudinal velocity, longitudinal speed"),
    (Channel(V), "sway velocity, sway speed, sway vel, v, transverse velocity, transverse speed, lateral speed"),
    (Channel(WaveHeight), "wave height, hs, wellenhohe, hauteur vagues"),
    (Channel(WaveDirection), "wave direction, wave dir"),
    (Channel(CurrentSpeed), "current speed, drift speed"),
    (Channel(CurrentDirection), "current direction, current dir"),
    (Channel(Depth), "depth, water depth, tiefe, wassertiefe, profondeur, profondita, profundidad"),
    (Variation, "variation, magnetic variation, mag var, magvar, declination, missweisung, declinaison"),
];

/// Phrases that name the same less surely: another column may be meant.
pub const VAGUE: &[(Meaning, &str)] = &[
    (GroundSpeed, "speed, spd, geschwindigkeit, fahrt, snelheid, vitesse, velocita, velocidad, fart"),
    (Channel(UWater), "log"),
    (Course, "kurs, route"),
    (Channel(X), "north, x"),
    (Channel(Y), "east, y"),
    (Channel(U), "surge"),
    (Channel(V), "sway"),
    (Channel(Delta), "delta, δ, helm, steering gear"),
    (Channel(Psi), "ψ"),
    (Channel(R), "r"),
    (Variation, "var"),
    (Channel(N), "n"),
];

/// Words that change nothing of what a column is: where it is from, how it was taken, which of several.
pub const NEUTRAL: &str = "a, act, actual, ais, angle, average, avg, bow, data, deg, direction, estimate, estimated, fb, fbk, feedback, \
         filtered, gnss, gps, ground, reply, response, ins, ist, istwert, main, mean, measured, measurement, meas, mru, nav, \
         own, pos, position, prop, propeller, pv, raw, sensor, shaft, ship, signal, smoothed, t, true, value, \
         vessel, vrai, wgs84, helice, elica, welle, schiff, rechtweisend, verdadero, vero, vera, over, of, \
         the, in, port, starboard, stbd, sb, ps, number, no";

/// Words that make a column something else of the thing that it names: how fast a rudder moves, whether its pump runs, when it was reported.
pub const CHANGES: &str = "acceleration, accel, acc, accuracy, age, alarm, apparent, aw, bearing, beschleunigung, bias, count, \
         covariance, cross, destination, dest, deviation, diff, difference, drag, dt, error, err, fan, force, \
         fuel, aux, auxiliary, alternator, generator, genset, dg, winch, gust, gyroscope, heave, interval, kraft, last, lift, limit, load, max, maximum, min, minimum, \
         mode, moment, oil, pitch, power, pressure, pump, quality, rate, residual, roll, running, rms, sigma, \
         slip, state, status, std, stddev, stamp, tau, temperature, temp, tide, time, torque, thrust, \
         tension, tw, turbo, turbocharger, update, updated, valid, var, variance, voltage, waypoint, wave, \
         wind, wp, wpt, xte, zeit";

/// Words that make an angle or a rudder its rate of change.
pub const MOVES: &str = "speed, velocity, vel, geschwindigkeit, vitesse, velocita, velocidad";

/// Words that make a column an order rather than a measurement.
pub const ORDERS: &str = "order, ordered, ord, command, commanded, cmd, set, setpoint, sp, demand, demanded, dmd, dem, desired, des, \
         target, ref, reference, request, requested, req, selected, autopilot, ap, soll, sollwert, consigne, consigna, \
         comando, impostato, impostata, ordre, orden, orde, gewenst, gewenste, bestilt";

/// Words of what drives a ship.
pub const DRIVES: &str =
    "propeller, prop, shaft, engine, me, motor, moteur, motore, screw, helice, elica, schraube, welle, maschine";

/// Names of a magnetic reference.
pub const MAGNETIC: &str = "magnetic, mag, hdm, compass, magnetisch, magnetique, magnetico, missweisend, mw";

/// Words of the wind.
pub const WIND: &str = "wind, vent, vento, viento, tws, twd, twa, aws, awa, awd, aw, tw";
/// The same where one word says wind and measure.
pub const WIND_SPEEDS: &str = "windgeschwindigkeit, windspeed, vindhastighet";
/// The same for directions.
pub const WIND_DIRECTIONS: &str = "windrichtung, winddirection, winddir, vindretning";
/// Words of a wind that a moving ship feels.
pub const RELATIVE: &str =
    "apparent, relative, rel, aw, aws, awa, awd, scheinbar, scheinbare, scheinbarer, apparente, aparente";
/// Words of the water, through which a speed is none over ground.
pub const WATER: &str =
    "water, current, log, wasser, vann, vannet, vatten, vattnet, vand, vandet, eau, acqua, agua, w, tw";
/// Words of a speed.
pub const SPEEDS: &str = "speed, spd, velocity, vel, tws, aws, geschwindigkeit, vitesse, velocita, velocidad";
/// Words of a direction that counts from north.
pub const FROM_NORTH: &str = "direction, dir, twd, awd, richtung, direzione, direccion, from";
/// Words of the direction that something goes to, where that of the wind is the one that it comes from.
pub const GOES_TO: &str = "to, towards, toward";
/// Words of a direction that counts from the bow.
pub const FROM_BOW: &str = "angle, twa, awa, winkel, einfallswinkel, angolo, angulo";

/// Words that are a time of their own.
pub const CLOCKS: &str = "timestamp, datetime, time, tvec, utc, epoch, unix, zeit, uhrzeit, zeitstempel, tid, tijd, heure, \
         horodatage, temps, ora, orario, tempo, hora, tiempo, fecha";
/// Names of the columns of a year, a month, a day, an hour, a minute and a second.
pub const CALENDAR: [&str; 6] = [
    "year, yyyy, yy, yr, jahr, annee, anno, ano",
    "month, mon, mo, mm, monat, mois, mese, mes",
    "day, dd, dy, d, tag, jour, giorno, dia",
    "hour, hours, hh, hr, h, stunde, heure, ora, hora",
    "minute, minutes, min, mi, mm, mn, m, minuto",
    "second, seconds, sec, ss, se, s, sekunde, seconde, secondo, segundo",
];
/// Words of a count of days of the year or of hours of the day, by its unit.
pub const COUNTS: [(&str, &str); 2] = [("d", "doy, yearday, julian, jday"), ("h", "hour, hours")];
/// Words that may stand beside them.
pub const BESIDE_COUNTS: &str = "day, of, the, year, decimal, utc, time, number, no";
/// Words of a time since something: of the start of a GPS week, of the days of MATLAB.
pub const SINCE: &str =
    "tow, datenum, stamp, elapsed, filetime, ticks, seconds, secs, sec, millis, secondes, segundos, secondi";
/// The name that LabVIEW gives the times of its rows.
pub const LABVIEW: &str = "x value";
/// Words of a column that identifies the ship of each row.
pub const SHIPS: &str = "mmsi, imo, callsign, vessel, ship, schiff, navire, nave, buque";
/// Words that may stand next to these in the name of such a column.
pub const BESIDE_SHIPS: &str = "name, id, number, no, nr, userid, source";

/// The words or phrases of a list.
pub fn phrases(list: &'static str) -> impl Iterator<Item = &'static str> {
    list.split(", ")
}

/// Whether a word is on a list.
pub fn is_on(list: &'static str, word: &str) -> bool {
    phrases(list).any(|w| w == word)
}

//! Files that are no log that is read here, identified by how they begin, each with what makes a log of it.
//! Nothing is unpacked or converted.

/// What a file begins with, what it is then, and what to do.
const BEGINNINGS: [(&[u8], &str, &str); 19] = [
    (b"MATLAB 7.3", "a MATLAB 7.3 file", "write its table with `writetable(T, \"log.csv\")`"),
    (b"ARROW1", "a Feather or Arrow file", "write it as CSV: `pandas.read_feather(FILE).to_csv(\"log.csv\")`"),
    (b"FEA1", "a Feather file", "write it as CSV: `pandas.read_feather(FILE).to_csv(\"log.csv\")`"),
    (b"ULog\x01\x12\x35", "a ULog of PX4", "write its topics as CSV with `ulog2csv FILE`"),
    (
        b"\xa3\x95\x80\x80",
        "a dataflash log of ArduPilot",
        "write its messages as CSV with `mavlogdump.py --format csv`",
    ),
    (b"MDF     ", "an MDF measurement file", "write its channels as CSV or Parquet"),
    (b"\x1f\x8b", "compressed (gzip)", "unpack it first, with `gunzip`"),
    (b"BZh", "compressed (bzip2)", "unpack it first, with `bunzip2`"),
    (b"\xfd7zXZ\0", "compressed (xz)", "unpack it first, with `unxz`"),
    (b"\x28\xb5\x2f\xfd", "compressed (Zstandard)", "unpack it first, with `unzstd`"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", "unpack it first"),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an Excel workbook", "save the sheet as CSV"),
    (b"MATLAB 5.0", "a MATLAB file", "write its table with `writetable(T, \"log.csv\")`"),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file (or MATLAB 7.3, or NetCDF 4)", "write its columns as CSV or Parquet"),
    (b"CDF", "a NetCDF file", "write its columns as CSV or Parquet"),
    (b"#ROSBAG", "a ROS bag", "export its topics as CSV"),
    (b"\x89MCAP", "a ROS bag (MCAP)", "export its topics as CSV"),
    (b"SQLite format 3", "an SQLite database", "export the table as CSV"),
    (b"%PDF", "a PDF document", "give the log it was made from"),
];

/// Bytes that are looked at.
const LOOKED_AT: usize = 4096;

/// What is to be said of a file that is no log; `None` where it may be one.
pub fn foreign(bytes: &[u8]) -> Option<String> {
    let refused = |what: &str, next: &str| Some(format!("is {what} and is not read; {next}"));
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Some("is empty; give a file with a line of column names and lines of data".to_owned());
    }
    if let Some((_, what, next)) = BEGINNINGS.iter().find(|(begins, ..)| bytes.starts_with(begins)) {
        return refused(what, next);
    }
    let head = &bytes[..bytes.len().min(LOOKED_AT)];
    let has = |word: &[u8]| head.windows(word.len()).any(|w| w == word);
    if bytes.starts_with(b"PK\x03\x04") {
        let workbook = has(b"[Content_Types].xml") || has(b"xl/");
        let sheet = || refused("a workbook (Excel)", "save the sheet as CSV");
        return if workbook { sheet() } else { refused("a zip archive", "unpack it first, with `unzip`") };
    }
    let text = head.trim_ascii_start();
    let marked = text.starts_with(b"<") && (has(b"<html") || has(b"<HTML") || has(b"<?xml") || has(b"<!DOCTYPE"));
    if marked {
        return refused("a page of HTML or XML", "give the log as CSV, NMEA 0183 or Parquet");
    }
    let object = text.strip_prefix(b"[").unwrap_or(text).trim_ascii_start();
    if object.starts_with(b"{") && has(b"\":") {
        return refused("JSON", "write its records as CSV or Parquet");
    }
    if is_candump(text) {
        return refused(
            "a log of CAN frames (candump)",
            "decode it to columns first, as with `cantools` or `analyzer -json`",
        );
    }
    let strange = head.iter().filter(|b| **b < 32 && !b.is_ascii_whitespace() && **b != 0x1a).count();
    // Text in UTF-16 has a nought in every other byte.
    let noughts = head.iter().filter(|b| **b == 0).count();
    let binary = bytes.starts_with(b"PAR1");
    (!binary && 20 * (strange - noughts) > head.len())
        .then(|| "contains bytes that are no text; give a CSV, NMEA 0183 or Parquet file".to_owned())
}

/// Whether a text begins with frames such as `(1620000000.123456) can0 09F80103#2A366C2B`, or those of candump without a file.
fn is_candump(text: &[u8]) -> bool {
    let Ok(line) = std::str::from_utf8(text.split(|b| *b == b'\n').next().unwrap_or(b"")) else { return false };
    let fields: Vec<&str> = line.split_whitespace().collect();
    let hex = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_hexdigit());
    let stamped = fields.first().is_some_and(|f| f.starts_with('(') && f.ends_with(')'));
    let frame = |f: &&str| f.split_once('#').is_some_and(|(id, data)| hex(id) && (data.is_empty() || hex(data)));
    let listed = fields.iter().any(|f| f.len() == 3 && f.starts_with('[') && f.ends_with(']'));
    let bus = fields.iter().take(2).any(|f| f.contains("can"));
    (stamped && fields.iter().any(frame)) || (bus && listed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_log_is_refused_with_what_to_do() {
        let cases: [(&[u8], &str); 14] = [
            (b"MATLAB 7.3 MAT-file, Platform: GLNXA64", "MATLAB 7.3"),
            (b"ARROW1\0\0\xff\xff", "Feather"),
            (b"ULog\x01\x12\x35\x01", "ULog"),
            (b"(1620000000.123456) can0 09F80103#2A366C2B\n", "candump"),
            (b"  can0  09F80103   [8]  2A 36 6C 2B 00 00 00 00\n", "candump"),
            (b"\x1f\x8b\x08\0", "gunzip"),
            (b"PK\x03\x04..........[Content_Types].xml", "save the sheet as CSV"),
            (b"PK\x03\x04..........log.csv", "unzip"),
            (b"MATLAB 5.0 MAT-file", "writetable"),
            (b"[\n {\"t\": 1}]", "JSON"),
            (b"<html><body>", "HTML"),
            (b"%PDF-1.4", "PDF"),
            (b" \n\n", "is empty"),
            (&[1, 2, 3, 200, 7, 9, 14, 30, 31], "no text"),
        ];
        for (bytes, expected) in cases {
            let said = foreign(bytes).unwrap();
            assert!(said.contains(expected), "{said}");
        }
        for log in [&b"t,x\n0,1\n"[..], b"t;psi [\xb0]\n0;1\n", b"\xff\xfet\0,\0x\0\n\0", b"{deg},x\n"] {
            assert_eq!(foreign(log), None);
        }
    }
}

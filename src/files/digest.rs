//! SHA-256 of bytes and of files, in hexadecimal.
//! What a digest is compared with is with those who ask.

use sha2::{Digest, Sha256};
use std::io::{Error, Read};
use std::path::Path;

/// SHA-256 of bytes: 64 hexadecimal digits, lower case.
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// SHA-256 of a file, which is read piece by piece.
///
/// # Errors
/// Those of the file system.
pub fn sha256_of(path: &Path) -> Result<String, Error> {
    let mut file = std::fs::File::open(path)?;
    let mut hash = Sha256::new();
    let mut piece = vec![0; 1 << 16];
    loop {
        match file.read(&mut piece)? {
            0 => return Ok(hexadecimal(&hash.finalize())),
            n => hash.update(&piece[..n]),
        }
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_of_abc_is_that_of_the_standard() -> Result<(), Error> {
        // FIPS 180-4, example of one block.
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(b"abc"), abc);
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("file");
        std::fs::write(&path, "abc")?;
        assert_eq!(sha256_of(&path)?, abc);
        let long = vec![7; 200_000];
        std::fs::write(&path, &long)?;
        assert_eq!(sha256_of(&path)?, sha256(&long));
        Ok(())
    }
}

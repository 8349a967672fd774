//! Pictures as files: one as PNG, many as GIF, or as MP4 through the program ffmpeg.

use crate::chart::{Picture, PictureError, Pixels};
use gif::{AnyExtension, Encoder, Frame, Repeat};
use output::files::made::{self, Made, OutputRefused};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use thiserror::Error;

/// Why pictures were not written.
#[derive(Debug, Error)]
pub enum FilmError {
    /// The name of the file has no ending that is known.
    #[error("{}: the name of a picture must end in .png, .gif or .mp4", .0.display())]
    Ending(PathBuf),
    /// Another file, which this program did not write, is in the way, or there is no folder.
    #[error(transparent)]
    Refused(#[from] OutputRefused),
    /// The program that writes MP4 is not there.
    #[error("{}: .mp4 is written by the program ffmpeg, which is not on the path", .0.display())]
    NoEncoder(PathBuf),
    /// That program failed.
    #[error("{}: ffmpeg failed: {reason}", path.display())]
    Encoder {
        /// The file.
        path: PathBuf,
        /// What it said last.
        reason: String,
    },
    /// The file cannot be written.
    #[error("cannot write {}: {cause}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        cause: std::io::Error,
    },
    /// A picture cannot be drawn.
    #[error(transparent)]
    Picture(#[from] PictureError),
}

impl FilmError {
    /// What the user can do about it.
    pub fn remedy(&self) -> Option<&'static str> {
        match self {
            Self::Ending(_) => Some(".png is one picture, .gif and .mp4 are films"),
            Self::Refused(refused) => Some(refused.remedy()),
            Self::NoEncoder(_) | Self::Encoder { .. } => Some(
                "install ffmpeg with libx264, or write a film whose name ends in .gif, which needs no other program",
            ),
            Self::Write { .. } => Some("check that the disk has room"),
            Self::Picture(_) => None,
        }
    }
}

/// The kind of a file of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmFormat {
    /// One picture.
    Png,
    /// A film with 256 colours in each picture.
    Gif,
    /// A film with all colours.
    Mp4,
}

impl FilmFormat {
    /// By the ending of a file's name.
    ///
    /// # Errors
    /// [`FilmError::Ending`].
    pub fn of(path: &Path) -> Result<Self, FilmError> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        match ending.to_ascii_lowercase().as_str() {
            "png" => Ok(Self::Png),
            "gif" => Ok(Self::Gif),
            "mp4" => Ok(Self::Mp4),
            _ => Err(FilmError::Ending(path.into())),
        }
    }

    /// Whether it holds many pictures.
    pub fn is_film(self) -> bool {
        self != Self::Png
    }

    /// How such files of this program are recognised.
    pub fn made(self) -> &'static Made {
        match self {
            Self::Png => &made::PNG,
            Self::Gif => &made::GIF,
            Self::Mp4 => &made::MP4,
        }
    }

    /// Refuses, before any work, a format that this machine cannot write to `path`.
    ///
    /// # Errors
    /// [`FilmError::NoEncoder`].
    pub fn check(self, path: &Path) -> Result<(), FilmError> {
        let quiet = || {
            Command::new(ENCODER)
                .arg("-version")
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .status()
        };
        if self == Self::Mp4 && quiet().is_err() {
            return Err(FilmError::NoEncoder(path.into()));
        }
        Ok(())
    }
}

/// The program that writes MP4. There is no encoder in Rust alone that is widely used.
const ENCODER: &str = "ffmpeg";

/// Writes pictures of equal size into a file, which gets its name once it is whole.
pub struct Film {
    path: PathBuf,
    partial: PathBuf,
    format: FilmFormat,
    width: u32,
    /// Hundredths of a second that each picture is shown.
    delay: u16,
    open: Option<Open>,
}

enum Open {
    Png,
    Gif(Box<Encoder<BufWriter<File>>>),
    Mp4(Child),
}

impl Film {
    /// A file for pictures `width` pixels wide, each shown for `delay` hundredths of a second.
    ///
    /// # Errors
    /// A name or format that cannot be written, see [`FilmError`]; a file that this program did not write.
    pub fn create<P: AsRef<Path>>(
        path: &Path,
        width: u32,
        delay: u16,
        inputs: &[P],
    ) -> Result<Self, FilmError> {
        let format = FilmFormat::of(path)?;
        made::check(path, format.made(), inputs)?;
        format.check(path)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let partial = path.with_file_name(format!(".{}.partial.{name}", std::process::id()));
        Ok(Self { path: path.into(), partial, format, width, delay, open: None })
    }

    /// Adds a picture.
    ///
    /// # Errors
    /// [`FilmError::Picture`], [`FilmError::Write`] and [`FilmError::Encoder`].
    pub fn add(&mut self, picture: &Picture) -> Result<(), FilmError> {
        let pixels = picture.pixels(self.width)?;
        let mut open = match self.open.take() {
            Some(open) => open,
            None => self.begin(&pixels)?,
        };
        let written = match &mut open {
            Open::Png => {
                File::create(&self.partial).and_then(|file| pixels.write_png(BufWriter::new(file)))
            }
            Open::Gif(encoder) => {
                // 10: a tenth of the pixels settles the colours, as the library advises for speed
                let sizes = [pixels.width, pixels.height].map(|n| n as u16);
                let mut frame = Frame::from_rgb_speed(sizes[0], sizes[1], &pixels.rgb, 10);
                frame.delay = self.delay;
                encoder.write_frame(&frame).map_err(std::io::Error::other)
            }
            Open::Mp4(encoder) => match &mut encoder.stdin {
                Some(pipe) => pipe.write_all(&pixels.rgb),
                None => Err(std::io::ErrorKind::BrokenPipe.into()),
            },
        };
        let encoded = matches!(open, Open::Mp4(_));
        self.open = Some(open);
        match written {
            // what ffmpeg said tells more than the broken pipe
            Err(_) if encoded => self.close(),
            other => other.map_err(|cause| self.failed(cause)),
        }
    }

    /// Ends the file and gives it its name.
    ///
    /// # Errors
    /// As for [`Self::add`].
    pub fn end(mut self) -> Result<(), FilmError> {
        self.close()?;
        std::fs::rename(&self.partial, &self.path).map_err(|cause| self.failed(cause))
    }

    fn failed(&self, cause: std::io::Error) -> FilmError {
        FilmError::Write { path: self.path.clone(), cause }
    }

    fn create_partial(&self) -> Result<BufWriter<File>, FilmError> {
        let file = File::create(&self.partial).map_err(|cause| self.failed(cause))?;
        Ok(BufWriter::new(file))
    }

    /// Opens the file for pictures of this size.
    fn begin(&self, pixels: &Pixels) -> Result<Open, FilmError> {
        let failed = |error| self.failed(std::io::Error::other::<gif::EncodingError>(error));
        match self.format {
            FilmFormat::Png => Ok(Open::Png),
            FilmFormat::Gif => {
                let sizes = [pixels.width, pixels.height].map(|n| n as u16);
                let file = self.create_partial()?;
                let mut encoder = Encoder::new(file, sizes[0], sizes[1], &[]).map_err(failed)?;
                let comment = AnyExtension(gif::Extension::Comment as u8);
                encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
                encoder
                    .write_raw_extension(comment, &[made::FILM_MARK.as_bytes()])
                    .map_err(failed)?;
                Ok(Open::Gif(Box::new(encoder)))
            }
            FilmFormat::Mp4 => self.encoder(pixels).map(Open::Mp4),
        }
    }

    /// Starts ffmpeg, which reads pixels from its standard input.
    fn encoder(&self, pixels: &Pixels) -> Result<Child, FilmError> {
        let size = format!("{}x{}", pixels.width, pixels.height);
        let rate = format!("100/{}", self.delay.max(1));
        let mark = format!("comment={}", made::FILM_MARK);
        Command::new(ENCODER)
            .args(["-hide_banner", "-loglevel", "error", "-y"])
            .args(["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &size, "-r", &rate, "-i", "-"])
            // what every player shows; the index in front, where the mark is looked for
            .args(["-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p"])
            .args(["-movflags", "+faststart", "-metadata", &mark, "-f", "mp4"])
            .arg(&self.partial)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|_| FilmError::NoEncoder(self.path.clone()))
    }

    /// Ends what is open, so that all is written.
    fn close(&mut self) -> Result<(), FilmError> {
        match self.open.take() {
            Some(Open::Gif(encoder)) => {
                let flushed = encoder.into_inner().map_err(std::io::Error::other);
                let flushed = flushed.and_then(|mut file| file.flush());
                flushed.map_err(|cause| self.failed(cause))
            }
            Some(Open::Mp4(encoder)) => {
                let failed = |reason| FilmError::Encoder { path: self.path.clone(), reason };
                // this closes its standard input
                let done = encoder.wait_with_output().map_err(|e| failed(e.to_string()))?;
                let said = String::from_utf8_lossy(&done.stderr);
                let last = said.lines().last().unwrap_or("it gave no reason");
                if done.status.success() {
                    Ok(())
                } else {
                    Err(failed(output::files::printable(last)))
                }
            }
            Some(Open::Png) | None => Ok(()),
        }
    }
}

impl Drop for Film {
    /// A film that was not ended leaves no file behind.
    fn drop(&mut self) {
        if let Some(Open::Mp4(mut encoder)) = self.open.take() {
            let _ = encoder.kill();
            let _ = encoder.wait();
        }
        let _ = std::fs::remove_file(&self.partial);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::{Key, Scale};

    fn picture(heading: &str) -> Picture {
        let key = Key::Values { label: "p (MPa)".into(), range: [0.0, 1.0], scale: Scale::Linear };
        Picture { heading: heading.into(), panes: vec![], key }
    }

    fn written(path: &Path, headings: &[&str]) -> Result<(), FilmError> {
        let mut film = Film::create::<&Path>(path, 200, 5, &[])?;
        headings.iter().try_for_each(|heading| film.add(&picture(heading)))?;
        film.end()
    }

    #[test]
    fn a_png_holds_the_pixels_of_its_picture_and_the_mark_of_this_program() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("one.PNG");
        written(&path, &["t = 1 s"]).unwrap();
        let mut reader = png::Decoder::new(File::open(&path).unwrap()).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size()];
        reader.next_frame(&mut bytes).unwrap();
        assert_eq!(bytes, picture("t = 1 s").pixels(200).unwrap().rgb);
        // that is how it may be written over
        written(&path, &["t = 2 s"]).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_gif_holds_every_picture_in_its_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.gif");
        written(&path, &["t = 1 s", "t = 2 s", "t = 3 s"]).unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut reader = options.read_info(File::open(&path).unwrap()).unwrap();
        let mut frames = Vec::new();
        while let Some(frame) = reader.read_next_frame().unwrap() {
            assert_eq!(frame.delay, 5);
            frames.push(frame.buffer.to_vec());
        }
        assert_eq!(frames.len(), 3);
        assert!(frames[0] != frames[1] && frames[1] != frames[2]);
        written(&path, &["t = 4 s"]).unwrap();
    }

    #[test]
    fn other_files_and_other_endings_are_refused_and_nothing_is_left_behind() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.gif");
        std::fs::write(&path, b"GIF89a of somebody").unwrap();
        let error = written(&path, &["x"]).unwrap_err();
        assert!(error.to_string().contains("not a film that this program wrote"), "{error}");
        let error = written(&folder.path().join("film.avi"), &["x"]).unwrap_err();
        assert!(error.to_string().contains(".png, .gif or .mp4"), "{error}");
        let other = folder.path().join("half.gif");
        let mut film = Film::create::<&Path>(&other, 200, 5, &[]).unwrap();
        film.add(&picture("x")).unwrap();
        drop(film);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}

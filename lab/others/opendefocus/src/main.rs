// OpenDefocus on the CPU: reads WIDTH x HEIGHT pixels of four floats from COLOUR and one float from RADII (the circle of confusion in
// pixels, positive before the focus, negative behind it), writes the defocused picture to OUTPUT and prints the seconds it took.
use futures::executor::block_on;
use ndarray::{Array2, Array3};
use opendefocus::OpenDefocusRenderer;
use opendefocus::datamodel::{Settings, defocus::DefocusMode, render::Quality};

type Any = Box<dyn std::error::Error>;

fn floats(path: &str) -> Result<Vec<f32>, Any> {
    let bytes = std::fs::read(path)?;
    Ok(bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
}

fn main() -> Result<(), Any> {
    let words: Vec<String> = std::env::args().collect();
    let [_, colour, radii, output, width, height, rings] = &words[..] else {
        return Err("usage: COLOUR RADII OUTPUT WIDTH HEIGHT RINGS".into());
    };
    let (width, height): (usize, usize) = (width.parse()?, height.parse()?);
    let mut image = Array3::from_shape_vec((height, width, 4), floats(colour)?)?;
    let radii = Array2::from_shape_vec((height, width), floats(radii)?)?;
    let largest = radii.iter().fold(1.0f32, |most, r| most.max(r.abs()));

    let mut settings = Settings::default();
    settings.defocus.set_defocus_mode(DefocusMode::Depth);
    settings.defocus.use_direct_math = true; // the radii are ours: those of the thin lens
    settings.defocus.circle_of_confusion.size = largest;
    settings.defocus.circle_of_confusion.max_size = largest;
    settings.defocus.circle_of_confusion.camera_data = None;
    settings.render.set_quality(Quality::Custom);
    settings.render.samples = rings.parse()?;
    settings.render.use_gpu_if_available = false;

    let start = std::time::Instant::now();
    let renderer = block_on(OpenDefocusRenderer::new(false, &mut settings))?;
    block_on(renderer.render(settings, image.view_mut(), Some(radii), None))?;
    println!("{:.3}", start.elapsed().as_secs_f64());
    std::fs::write(output, image.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>())?;
    Ok(())
}

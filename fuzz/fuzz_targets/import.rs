#![no_main]
libfuzzer_sys::fuzz_target!(|data: &[u8]| runs::inputs::read("import", data));

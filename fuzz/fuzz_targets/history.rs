#![no_main]
libfuzzer_sys::fuzz_target!(|data: &[u8]| runs::inputs::read("history", data));

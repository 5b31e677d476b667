// The format of mesh_fuzz.cpp, which is compiled once for all of them.
extern const char* const lamella_fuzz_format;
const char* const lamella_fuzz_format = LAMELLA_FUZZ_FORMAT;

// Carries the precompiled headers of the tests: muldi_test_headers in tools/cmake.
int main() { return 0; }

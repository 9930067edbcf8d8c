/// golden_drop_checkpoint FILE: leaves out the checkpoint, which nothing compares and which holds every unknown of
/// every solid several times.
#include <hdf5.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace {

struct Copy {
  hid_t from;
  hid_t to;
};

herr_t copy_link(hid_t, const char* name, const H5L_info_t*, void* data) {
  const auto* copy = static_cast<const Copy*>(data);
  if (std::string(name) == "checkpoint") return 0;
  return H5Ocopy(copy->from, name, copy->to, name, H5P_DEFAULT, H5P_DEFAULT);
}

herr_t copy_attribute(hid_t from, const char* name, const H5A_info_t*, void* data) {
  const hid_t old = H5Aopen(from, name, H5P_DEFAULT);
  const hid_t type = H5Aget_type(old);
  const hid_t space = H5Aget_space(old);
  std::string value(H5Tget_size(type) * static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)), '\0');
  herr_t status = H5Aread(old, type, value.data());
  const hid_t made = H5Acreate2(static_cast<const Copy*>(data)->to, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  if (status >= 0) status = H5Awrite(made, type, value.data());
  H5Aclose(made);
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(old);
  return status;
}

bool copy_file(const std::string& from, const std::string& to) {
  Copy copy{.from = H5Fopen(from.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
            .to = H5Fcreate(to.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)};
  if (copy.from < 0 || copy.to < 0) return false;
  const bool good = H5Literate(copy.from, H5_INDEX_NAME, H5_ITER_INC, nullptr, copy_link, &copy) >= 0 &&
                    H5Aiterate2(copy.from, H5_INDEX_NAME, H5_ITER_INC, nullptr, copy_attribute, &copy) >= 0;
  H5Fclose(copy.from);
  return H5Fclose(copy.to) >= 0 && good;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: golden_drop_checkpoint FILE\n", stderr);
    return 2;
  }
  const std::string file = argv[1];
  if (!copy_file(file, file + ".slim")) {
    std::fprintf(stderr, "cannot copy %s\n", file.c_str());
    return 1;
  }
  std::filesystem::rename(file + ".slim", file);
}

// SPDX-License-Identifier: MIT
// Reading the vertices of meshes.
#include <doctest/doctest.h>

#include <algorithm>

#include "encoder/import/import.hpp"
#include "tests/support/binary_file.hpp"
#include "tests/support/imports.hpp"

using namespace microtin::tests;

namespace {

std::string ply(const std::string& bytes) {
  return text_of(import_ply("mesh", bytes));
}

std::string ply_error(const std::string& bytes) {
  return import_error([&] { ply(bytes); });
}

std::string obj(const std::string& text) {
  return text_of(import_obj("mesh", text));
}

std::string obj_error(const std::string& text) {
  return import_error([&] { obj(text); });
}

const std::string kXyz = "property float x\nproperty double y\nproperty short z\n";

std::string text_head(const std::string& rest) {
  return "ply\nformat ascii 1.0\n" + rest;
}

std::string binary_head(bool big_endian, const std::string& rest) {
  return std::string("ply\nformat binary_") + (big_endian ? "big" : "little") + "_endian 1.0\n" +
         rest;
}

}  // namespace

TEST_CASE("ply: text, with any elements and properties around") {
  CHECK(ply(text_head("comment a\nobj_info b\nelement camera 2\nproperty list uchar int c\n"
                      "element vertex 2\nproperty uchar red\nproperty list int float w\n" +
                      kXyz +
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                      "0\n3 1 2 3\n255 2 7 8 1.5 -2 3\r\n\n1 0 4 5e-1 6\n3 0 1 0\n")) ==
        "15,-20,3 40,5,6");
}

TEST_CASE("ply: binary, of either byte order and every type") {
  for (const bool big_endian : {false, true}) {
    BinaryFile file(big_endian);
    file.add(binary_head(big_endian,
                         "element camera 2\nproperty list ushort int8 c\nelement vertex "
                         "2\nproperty list uint8 float32 w\n" +
                             kXyz + "end_header\n"));
    file.add(uint16_t{3}).add(std::string("abc")).add(uint16_t{0});
    file.add(uint8_t{1}).add(7.0f).add(0.1f).add(-2.25).add(int16_t{-300});
    file.add(uint8_t{0}).add(639000.06f).add(1e-9).add(int16_t{300});
    CHECK(ply(file.bytes()) == "100000000,-2250000000,-300 639000060000000,1,300");
  }
  const auto single = [](const std::string& type, auto value) {
    BinaryFile file;
    file.add(binary_head(false, "element vertex 1\nproperty " + type + " x\nproperty " + type +
                                    " y\nproperty " + type + " z\nend_header\n"));
    return ply(file.add(value).add(value).add(value).bytes());
  };
  CHECK(single("char", int8_t{-5}) == "-5,-5,-5");
  CHECK(single("uint8", uint8_t{250}) == "250,250,250");
  CHECK(single("ushort", uint16_t{65535}) == "65535,65535,65535");
  CHECK(single("int32", int32_t{-2000000000}) == "-2000000000,-2000000000,-2000000000");
  CHECK(single("uint", uint32_t{4000000000}) == "4000000000,4000000000,4000000000");
}

TEST_CASE("ply: coordinates in capitals, as QGIS names them") {
  const std::string capitals = "element vertex 1\nproperty double X\nproperty double Y\n";
  CHECK(ply(text_head(capitals + "property double Z\nend_header\n500000 4500000 100.5 \n")) ==
        "500000,4500000,1005");
  CHECK(ply(text_head(capitals + "property int x\nproperty int z\nend_header\n1 2 3 4\n")) ==
        "3,2,4");
}

TEST_CASE("ply and obj: decimal commas are refused with the remedy") {
  const std::string remedy = "\" is not a number in range; decimals are written with a point";
  CHECK(obj_error("v 500000,25 4500000,50 100,00\nv 500010,75 4500000,25 101,00\n") ==
        "mesh:1: \"500000,25" + remedy);
  CHECK(obj_error("v 1 2 3\nv 1 2 3,5\n") == "mesh:2: \"3,5" + remedy);
  CHECK(obj_error("v 1,2,3,4\n") == "mesh:1: a vertex needs three numbers");
  const std::string one = text_head("element vertex 1\n" + kXyz + "end_header\n");
  CHECK(ply_error(one + "1,5 2,5 3\n") == "mesh:8: \"1,5" + remedy);
  const std::string six = "property int r\nproperty int g\nproperty int b\nend_header\n";
  CHECK(ply_error(text_head("element vertex 1\n" + kXyz + six) + "1,5 2,5 3,5\n") ==
        "mesh:11: the line does not hold the element's values");
}

TEST_CASE("ply and obj: lines that end with CR alone") {
  CHECK(obj("v 1 2 3\rv 4 5 6\r") == "1,2,3 4,5,6");
  std::string text = text_head("element vertex 2\n" + kXyz + "end_header\n1 2 3\n4 5 6\n");
  std::string binary = BinaryFile(false)
                           .add(binary_head(false, "element vertex 1\n" + kXyz + "end_header\n"))
                           .bytes();
  std::replace(text.begin(), text.end(), '\n', '\r');
  CHECK(ply(text) == "1,2,3 4,5,6");
  std::replace(binary.begin(), binary.end(), '\n', '\r');
  BinaryFile file;
  file.add(binary).add(std::string("\n\0\0\0", 4)).add(2.0).add(int16_t{3});  // begins with LF
  CHECK(ply(file.bytes()) != "");
}

TEST_CASE("ply: every error is reported, in text with its line") {
  CHECK(ply_error("") == "mesh:0: is not a PLY file");
  CHECK(ply_error("plyx\n") == "mesh:1: is not a PLY file");
  CHECK(ply_error("ply\nformat ascii 1.0\n") == "mesh:2: the header does not end");
  CHECK(ply_error("ply\nend_header\n") == "mesh:2: the header lacks the format");
  CHECK(ply_error("ply\nformat ebcdic 1.0\n") == "mesh:2: the format is not one of PLY's");
  CHECK(ply_error("ply\nfoo\n") == "mesh:2: \"foo\" is not a keyword of a PLY header");
  CHECK(ply_error("ply\nelement vertex -1\n") == "mesh:2: an element needs a count");
  CHECK(ply_error("ply\nproperty int x\n") == "mesh:2: a property comes before any element");
  CHECK(ply_error("ply\nelement vertex 1\nproperty x\n") ==
        "mesh:3: a property needs a type and a name");
  CHECK(ply_error("ply\nelement vertex 1\nproperty int128 x\n") ==
        "mesh:3: the property's type is not one of PLY's");
  CHECK(ply_error("ply\nelement vertex 1\nproperty list float int x\n") ==
        "mesh:3: the property's type is not one of PLY's");
  const std::string one = text_head("element vertex 1\n" + kXyz + "end_header\n");
  CHECK(ply_error(one) == "mesh:7: the file ends before its elements do");
  CHECK(ply_error(one + "1 2\n") == "mesh:8: the line does not hold the element's values");
  CHECK(ply_error(one + "1 2 3 4\n") == "mesh:8: the line does not hold the element's values");
  CHECK(ply_error(one + "1 nan 3\n") == "mesh:8: \"nan\" is not a number in range");
  CHECK(ply_error(text_head("element vertex 1\nproperty list int int x\nproperty int y\nproperty "
                            "int z\nend_header\n1 2 3 4\n")) ==
        "mesh: its vertices have no property x");
  CHECK(ply_error(text_head("element face 0\nend_header\n")) == "mesh: holds no vertex");
  CHECK(ply_error(text_head("element vertex 0\n" + kXyz + "end_header\n")) ==
        "mesh: holds no vertex");
  CHECK(ply_error(text_head("element f 1\nproperty list int int i\nelement vertex 1\n" + kXyz +
                            "end_header\n3\n")) == "mesh:10: the file ends before its elements do");
  BinaryFile file;
  file.add(binary_head(false, "element vertex 1000000000000\n" + kXyz + "end_header\n"));
  file.add(1.0f / 0.0f).add(2.0).add(int16_t{3});
  CHECK(ply_error(file.bytes()) == "mesh: vertex 0: x is not a number in range");
  BinaryFile list;
  list.add(binary_head(false, "element f 1\nproperty list int double i\nend_header\n"));
  CHECK(ply_error(BinaryFile(list).add(int32_t{-1}).bytes()) ==
        "mesh: a list has a negative length");
  CHECK(ply_error(BinaryFile(list).add(int32_t{2000000000}).bytes()) ==
        "mesh: cut off: has 4 bytes, but names more");
}

TEST_CASE("obj: vertices alone count, weights and colours do not") {
  CHECK(
      obj("# a mesh\no hill\nv 1 2 3\nvt 0 0\nvn 0 0 1\nv\t-1.5 0 2 0.1 0.2 0.3\r\nf 1 2 1\n  v 0 "
          "0 0 1") == "10,20,3 -15,0,2 0,0,0");
  CHECK(obj_error("") == "mesh: holds no vertex");
  CHECK(obj_error("vn 0 0 1\n") == "mesh: holds no vertex");
  CHECK(obj_error("v 1 2 3\nv 1 2\n") == "mesh:2: a vertex needs three numbers");
  CHECK(obj_error("v 1 2 x\n") == "mesh:1: \"x\" is not a number in range");
  CHECK(obj_error("v 1 2 3 x\n") == "mesh:1: \"x\" is not a number in range");
}

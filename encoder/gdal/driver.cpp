// SPDX-License-Identifier: MIT
// What GDAL calls when it has loaded the plugin.
#include <microtin/microtin.h>

#include <microtin/encoder.hpp>
#include <string>

#include "encoder/gdal/dataset.hpp"

extern "C" CPL_DLL void GDALRegister_MTIN();

void GDALRegister_MTIN() {
  if (!GDAL_CHECK_VERSION("MTIN") || GDALGetDriverByName("MTIN") != nullptr) return;
  auto driver = std::make_unique<GDALDriver>();
  driver->SetDescription("MTIN");
  driver->SetMetadataItem(GDAL_DMD_LONGNAME, "microtin terrain: stream (.mtin) or pack (.mtp)");
  driver->SetMetadataItem(GDAL_DMD_EXTENSIONS, "mtin mtp");
  driver->SetMetadataItem(GDAL_DCAP_RASTER, "YES");
  driver->SetMetadataItem(GDAL_DCAP_VECTOR, "YES");
  driver->SetMetadataItem(GDAL_DCAP_CREATECOPY, "YES");
  driver->SetMetadataItem(GDAL_DCAP_VIRTUALIO, "YES");
  driver->SetMetadataItem(GDAL_DCAP_Z_GEOMETRIES, "YES");
  driver->SetMetadataItem(GDAL_DMD_CREATIONDATATYPES,
                          "Byte Int16 UInt16 Int32 UInt32 Float32 Float64");
  driver->SetMetadataItem(
      GDAL_DMD_OPENOPTIONLIST,
      "<OpenOptionList>"
      "<Option name='CELL_SIZE' type='string' description='Size of the raster&apos;s cells in "
      "units of x and y, if not that of the source'/>"
      "</OpenOptionList>");
  const std::string usual_vertices = std::to_string(microtin::encoder::kUsualTileVertices);
  const std::string creation_options =
      "<CreationOptionList>"
      "<Option name='MAX_ERROR' type='string' description='Bound: largest error of any height, in "
      "its unit; without, every height is kept'/>"
      "<Option name='MAX_VERTICES' type='int' description='Of streams: the smallest error that "
      "this "
      "number of vertices allows'/>"
      "<Option name='MAX_BYTES' type='int' description='Of streams: the smallest error that a file "
      "of this size allows'/>"
      "<Option name='NEVER_BELOW' type='boolean' description='With a bound: no height is below the "
      "source'/>"
      "<Option name='BOUND_AT' type='string-select' default='POINTS' description='Whether "
      "the bound holds at the posts or everywhere between them'>"
      "<Value>POINTS</Value><Value>EVERYWHERE</Value></Option>"
      "<Option name='Z_STEP' type='string' description='Step of heights'/>"
      "<Option name='XY_STEP' type='string' description='Of streams: step of positions, in posts'/>"
      "<Option name='EFFORT' type='string-select' default='NORMAL'>"
      "<Value>FAST</Value><Value>NORMAL</Value><Value>BEST</Value></Option>"
      "<Option name='CODING' type='string-select' default='BALANCED'>"
      "<Value>QUICK</Value><Value>BALANCED</Value><Value>DENSE</Value></Option>"
      "<Option name='MAX_DEGREE' type='int' min='6' max='32' description='The most triangles "
      "around "
      "a vertex when it is added'/>"
      "<Option name='TILE_VERTICES' type='int' min='16' default='" +
      usual_vertices +
      "' description='Of packs: vertices of a tile at most'/>"
      "<Option name='TILE_SIZE' type='int' description='Of packs: extent of a tile in posts'/>"
      "<Option name='UNITS' type='string' description='Units of x and y and of heights, such as "
      "degree:metre or :foot'/>"
      "<Option name='DEPTHS' type='boolean' description='Heights grow downwards, and are negated'/>"
      "<Option name='SURFACE' type='string-select' default='UNKNOWN' description='Note: what the "
      "heights are'>"
      "<Value>UNKNOWN</Value><Value>GROUND</Value><Value>TOP</Value><Value>BED</Value>"
      "<Value>GEOID</Value><Value>OBSTACLES</Value></Option>"
      "<Option name='SOURCE_NAME' type='string' description='Note: where the terrain comes from'/>"
      "<Option name='DATE' type='string' description='Note: date of the source, such as 2026-11 or "
      "2019-05/2021'/>"
      "<Option name='LINEAGE' type='string' description='Note: how the source was processed'/>"
      "<Option name='ATTRIBUTION' type='string' description='Note: a text to be shown to users'/>"
      "<Option name='LICENSE' type='string' description='Note: an SPDX expression or a URL'/>"
      "<Option name='VALID' type='string' description='Note: when the terrain is valid, such as "
      "2024-01/2025-06 or 2024-01/..'/>"
      "<Option name='EPOCH' type='string' description='Note: epoch of the coordinates, such as "
      "2020.5'/>"
      "<Option name='SOURCE_ACCURACY' type='string' description='Note: accuracy of the source, "
      "such as LE90 4'/>"
      "<Option name='DIGEST' type='boolean' description='Of streams: note a digest of the mesh'/>"
      "<Option name='PHASES' type='boolean' description='Of streams: note vertices, bytes and "
      "largest error after each phase'/>"
      "<Option name='ERROR_MAP' type='string' description='A bound for each height: a raster of "
      "bounds, or polygons with a field max_error; elsewhere MAX_ERROR holds'/>"
      "<Option name='AREA' type='string' description='Keep the heights in the polygons of this "
      "file'/>"
      "<Option name='ROUTE' type='string' description='Keep the heights near the lines of this "
      "file; needs ROUTE_WIDTH'/>"
      "<Option name='ROUTE_WIDTH' type='string' description='Metres around a route, half on each "
      "side'/>"
      "<Option name='ROUTE_EDGE_ERROR' type='string' description='The bound at the edges of "
      "ROUTE_WIDTH, to which it grows from MAX_ERROR at a route'/>"
      "<Option name='BREAKLINES' type='string' description='A file of lines along which the "
      "surface has edges; not for packs of points'/>"
      "<Option name='OBSTACLES' type='string' description='Raise the terrain to what "
      "stands on it, by this file of points, lines and polygons; needs MAX_ERROR'/>"
      "</CreationOptionList>";
  driver->SetMetadataItem(GDAL_DMD_CREATIONOPTIONLIST, creation_options.c_str());
  driver->pfnIdentify = microtin::gdal::identify;
  driver->pfnOpen = microtin::gdal::Dataset::open;
  driver->pfnCreateCopy = microtin::gdal::create_copy;
  GetGDALDriverManager()->RegisterDriver(driver.release());
}

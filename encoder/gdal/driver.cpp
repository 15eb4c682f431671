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
      "<Option name='MAX_ERROR' type='string' description='Largest error of any height, in its "
      "unit; without, every height is kept'/>"
      "<Option name='NEVER_BELOW' type='boolean' description='No height is below the source'/>"
      "<Option name='Z_STEP' type='string' description='Step of heights'/>"
      "<Option name='EFFORT' type='string-select' default='NORMAL'>"
      "<Value>FAST</Value><Value>NORMAL</Value><Value>BEST</Value></Option>"
      "<Option name='CODING' type='string-select' default='BALANCED'>"
      "<Value>QUICK</Value><Value>BALANCED</Value><Value>DENSE</Value></Option>"
      "<Option name='UNITS' type='string' description='Units of x and y and of heights, such as "
      "degree:metre or :foot'/>"
      "<Option name='DEPTHS' type='boolean' description='Heights grow downwards, and are negated'/>"
      "<Option name='TILE_VERTICES' type='int' default='" +
      usual_vertices +
      "' description='Of packs: vertices of a tile at most'/>"
      "</CreationOptionList>";
  driver->SetMetadataItem(GDAL_DMD_CREATIONOPTIONLIST, creation_options.c_str());
  driver->pfnIdentify = microtin::gdal::identify;
  driver->pfnOpen = microtin::gdal::Dataset::open;
  driver->pfnCreateCopy = microtin::gdal::create_copy;
  GetGDALDriverManager()->RegisterDriver(driver.release());
}

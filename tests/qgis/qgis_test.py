# SPDX-License-Identifier: MIT
"""qgis_test.py [PICTURE]: QGIS, without a screen, opens a stream and a pack as raster and as mesh; PICTURE gets both of the
stream, side by side. Skipped (77) without python3-qgis, numpy or python3-gdal."""

import os
import subprocess
import sys
import tempfile

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
try:
    import numpy
    from osgeo import gdal
    from PyQt5.QtCore import QSize
    from PyQt5.QtGui import QColor, QImage, QPainter
    from qgis.core import (
        Qgis,
        QgsApplication,
        QgsGradientColorRamp,
        QgsHillshadeRenderer,
        QgsMapRendererParallelJob,
        QgsMapSettings,
        QgsMeshDatasetIndex,
        QgsMeshLayer,
        QgsPointXY,
        QgsRasterDataProvider,
        QgsRasterLayer,
        QgsRectangle,
    )
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

TOOL = os.environ["MICROTIN_TOOL"]
SIDE, CELL, BOUND = 257, 30, 8


def check(holds, what):
    if not holds:
        raise SystemExit(f"failed: {what}")


def rendered(layer):
    """Its south-western quarter."""
    extent = layer.extent()
    extent = QgsRectangle(extent.xMinimum(), extent.yMinimum(), extent.center().x(), extent.center().y())
    settings = QgsMapSettings()
    settings.setLayers([layer])
    settings.setExtent(extent)
    settings.setDestinationCrs(layer.crs())
    settings.setOutputSize(QSize(384, 384))
    settings.setBackgroundColor(QColor(255, 255, 255))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    return job.renderedImage()


def colours(image):
    return {image.pixel(x, y) for x in range(0, image.width(), 5) for y in range(0, image.height(), 5)}


def check_raster(path, heights):
    layer = QgsRasterLayer(path, "raster", "gdal")
    check(layer.isValid(), f"{path} as a raster")
    check(layer.crs().authid() == "EPSG:25832", "the raster's system")
    check((layer.width(), layer.height()) == (SIDE, SIDE), "the raster's size")
    for row, column in ((0, 0), (17, 200), (SIDE - 1, SIDE - 1)):
        value, found = layer.dataProvider().sample(QgsPointXY(column * CELL, (SIDE - 1 - row) * CELL), 1)
        check(found and abs(value - heights[row, column]) <= BOUND + 1e-6, f"the height at {row}, {column}")
    layer.setResamplingStage(Qgis.RasterResamplingStage.Provider)  # else the shading shows the posts' edges
    layer.dataProvider().enableProviderResampling(True)
    layer.dataProvider().setZoomedInResamplingMethod(QgsRasterDataProvider.ResamplingMethod.Cubic)
    layer.setRenderer(QgsHillshadeRenderer(layer.dataProvider(), 1, 315, 45))
    image = rendered(layer)
    check(len(colours(image)) > 50, "the raster's picture shows nothing")
    return image


def check_mesh(path, heights):
    layer = QgsMeshLayer(path, "mesh", "mdal")
    check(layer.isValid(), f"{path} as a mesh")
    check(layer.crs().authid() == "EPSG:25832", "the mesh's system")
    provider = layer.dataProvider()
    check(provider.vertexCount() > 100 and provider.faceCount() > 100, "the mesh's size")
    layer.updateTriangularMesh()
    index = QgsMeshDatasetIndex(0, 0)
    for row, column in ((1, 1), (17, 200), (100, 101)):
        value = layer.datasetValue(index, QgsPointXY(column * CELL, (SIDE - 1 - row) * CELL)).scalar()
        # From the true triangles, not their rounded heights.
        check(abs(value - heights[row, column]) <= BOUND + 0.1, f"the mesh's height at {row}, {column}: {value}")
    settings = layer.rendererSettings()
    settings.setActiveScalarDatasetGroup(0)
    scalar = settings.scalarSettings(0)
    shader = scalar.colorRampShader()
    shader.setSourceColorRamp(QgsGradientColorRamp(QColor(38, 94, 66), QColor(246, 240, 222)))
    shader.setMinimumValue(heights.min())
    shader.setMaximumValue(heights.max())
    shader.classifyColorRamp(12)
    scalar.setColorRampShader(shader)
    settings.setScalarSettings(0, scalar)
    lines = settings.nativeMeshSettings()
    lines.setEnabled(True)
    lines.setColor(QColor(60, 60, 60))
    lines.setLineWidth(0.1)
    settings.setNativeMeshSettings(lines)
    layer.setRendererSettings(settings)
    check(layer.extent().width() == (SIDE - 1) * CELL, "the mesh's extent")
    image = rendered(layer)
    check(len(colours(image)) > 50, "the mesh's picture shows nothing")
    return image


def check_damaged(path):
    with open(path, "rb") as file:
        data = bytearray(file.read())
    data[len(data) // 2] ^= 1
    with open(path, "wb") as file:
        file.write(data)
    check(not QgsMeshLayer(path, "damaged", "mdal").isValid(), "a damaged stream is refused as a mesh")
    check(not QgsRasterLayer(path, "damaged", "gdal").isValid(), "a damaged stream is refused as a raster")


def beside(left, right):
    picture = QImage(left.width() + right.width() + 8, left.height(), QImage.Format_RGB32)
    picture.fill(QColor(255, 255, 255))
    painter = QPainter(picture)
    painter.drawImage(0, 0, left)
    painter.drawImage(left.width() + 8, 0, right)
    painter.end()
    return picture


def main():
    application = QgsApplication([], False)
    application.initQgis()
    gdal.UseExceptions()
    with tempfile.TemporaryDirectory() as folder:
        source, stream, pack = (os.path.join(folder, name) for name in ("a.asc", "a.mtin", "a.mtp"))
        subprocess.run([TOOL, "fractal", "--size", str(SIDE), "-o", source], check=True, capture_output=True)
        encode = [TOOL, "encode", source, "--max-error", str(BOUND), "--epsg", "25832", "--fast"]
        subprocess.run([*encode, "-o", stream], check=True, capture_output=True)
        subprocess.run([*encode, "--tile-vertices", "1000", "-o", pack], check=True, capture_output=True)
        heights = gdal.Open(source).ReadAsArray()
        check(gdal.Open(source).GetGeoTransform()[1] == CELL, "the source's cells")
        for path in (pack, stream):
            images = check_raster(path, heights), check_mesh(path, heights)
        if len(sys.argv) > 1:
            beside(*images).save(sys.argv[1])
        check_damaged(stream)
    print("a stream and a pack are rasters and meshes in QGIS")
    sys.stdout.flush()
    application.exitQgis()


main()

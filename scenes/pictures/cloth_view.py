# SPDX-License-Identifier: MIT
"""Draws one cloth into one panel: colouring, light, camera. Off-screen, in VTK."""

import math
from dataclasses import dataclass

import numpy as np
from PIL import Image
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkFeatureEdges, vtkPolyDataNormals, vtkTubeFilter
from vtkmodules.vtkFiltersSources import vtkLineSource, vtkRegularPolygonSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import (vtkActor, vtkLight, vtkPolyDataMapper, vtkProperty, vtkRenderer,
                                         vtkRenderWindow, vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # registers the OpenGL implementations  # noqa: F401

BACKGROUND = (0.20, 0.23, 0.27)
CLOTH_FRONT = (0.40, 0.62, 0.80)
CLOTH_BACK = (0.85, 0.76, 0.60)
COLLIDER = (0.48, 0.51, 0.55)
INSIDE = 0.985  # of a collider's radius, for drawing
SUPERSAMPLING = 2
FEATURE_ANGLE = 75.0  # degrees; sharper creases than this keep a crease, all else is shaded smoothly


@dataclass(frozen=True)
class Colouring:
    array: str  # the cell data that is shown
    white: float  # its value that is white
    red: float  # and pure red, as are those above


@dataclass(frozen=True)
class Camera:
    position: tuple  # m
    focal_point: tuple  # m
    up: tuple
    view_angle: float  # degrees, over the panel's height
    scene_radius: float  # m; what the cloth can reach from the focal point


def fit_camera(points, aspect, azimuth=30.0, elevation=15.0, zoom=1.0, view_angle=25.0):
    """The camera that looks from `azimuth` (degrees from +z towards +x) and `elevation` and holds all of `points`.

    points: [N, 3], m. aspect: the panel's width over its height.
    """
    points = points[np.isfinite(points).all(axis=1)]
    if len(points) == 0:
        points = np.zeros((1, 3))
    a, e = math.radians(azimuth), math.radians(elevation)
    backward = np.array([math.sin(a) * math.cos(e), math.sin(e), math.cos(a) * math.cos(e)])
    right = np.array([math.cos(a), 0.0, -math.sin(a)])
    up = np.cross(backward, right)
    axes = np.stack([right, up, backward])
    x, y, z = (points @ axes.T).T
    # A point is inside the picture where |x - cx| <= t (d - z), t the tangent of half the angle: the smallest d
    # and the centre c follow from the greatest of z + x/t and of z - x/t.
    half_height = math.tan(math.radians(view_angle) / 2) / 1.06
    distances, centre = [], []
    for across, tangent in ((x, half_height * aspect), (y, half_height)):
        right_most, left_most = (z + across / tangent).max(), (z - across / tangent).max()
        distances.append(0.5 * (right_most + left_most))
        centre.append(0.5 * tangent * (right_most - left_most))
    depth = 0.5 * (z.min() + z.max())
    distance = max(float(max(distances)) - depth, 1e-3) / zoom
    focal_point = np.array([*centre, depth]) @ axes
    radius = max(float(np.linalg.norm(points - focal_point, axis=1).max()), 1e-3)
    return Camera(tuple(focal_point + distance * backward), tuple(focal_point), tuple(up), view_angle, radius)


def white_to_red():
    """White at 0, pure red at the top of the range and above it; what is not finite is red too."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for entry in range(256):
        rest = 1.0 - entry / 255.0
        table.SetTableValue(entry, 1.0, rest, rest, 1.0)
    table.SetNanColor(1.0, 0.0, 0.0, 1.0)
    table.Build()
    return table


class ClothView:
    """An off-screen window of one panel. Kept between frames: opening one costs more than drawing in it."""

    def __init__(self, width, height, camera, colliders=()):
        self._renderer = vtkRenderer()
        self._renderer.SetBackground(*BACKGROUND)
        self._renderer.SetTwoSidedLighting(True)
        self._renderer.SetAutomaticLightCreation(False)
        self._window = vtkRenderWindow()
        self._window.SetOffScreenRendering(1)
        self._window.SetMultiSamples(0)
        self._window.SetSize(SUPERSAMPLING * width, SUPERSAMPLING * height)
        self._window.AddRenderer(self._renderer)
        self._size = (width, height)
        self._place_camera(camera)
        self._place_lights()
        self._moving = []
        for collider in colliders:
            actor = collider_actor(collider, camera)
            if actor is not None:
                self._renderer.AddActor(actor)
                if "motion" in collider:
                    self._moving.append((actor, collider))
        self._build_cloth()

    def move_colliders(self, time):
        """To where their motion has them at `time`, s; where they are at first without a time."""
        for actor, collider in self._moving:
            actor.SetUserTransform(carried(collider, 0.0 if np.isnan(time) else time))

    def draw(self, surface, colouring=None):
        """A picture of the panel; plain material without a colouring."""
        self._normals.SetInputData(surface)
        self._edges.SetInputData(surface)
        mapper = self._cloth.GetMapper()
        mapper.SetScalarVisibility(colouring is not None)
        if colouring is None:
            self._cloth.SetBackfaceProperty(self._back)
            self._cloth.SetProperty(self._front)
        else:
            mapper.SelectColorArray(colouring.array)
            mapper.SetScalarRange(colouring.white, max(colouring.red, colouring.white + 1e-30))
            self._cloth.SetBackfaceProperty(None)
            self._cloth.SetProperty(self._coloured)
        self._renderer.ResetCameraClippingRange()
        self._window.Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(self._window)
        grab.ReadFrontBufferOff()
        grab.Update()
        image = grab.GetOutput()
        columns, rows, _ = image.GetDimensions()
        pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, -1)[::-1, :, :3]
        return Image.fromarray(np.ascontiguousarray(pixels)).resize(self._size, Image.BOX)

    def _place_camera(self, camera):
        view = self._renderer.GetActiveCamera()
        view.SetPosition(*camera.position)
        view.SetFocalPoint(*camera.focal_point)
        view.SetViewUp(*camera.up)
        view.SetViewAngle(camera.view_angle)

    def _place_lights(self):
        # In the camera's frame: a key from the upper left, well off the axis, draws the folds; a fill from the lower
        # right keeps what hangs over, its underside to the camera, from going black.
        for position, strength in (((-1.5, 1.0, 1.5), 0.68), ((1.3, -1.0, 1.2), 0.38)):
            light = vtkLight()
            light.SetLightTypeToCameraLight()
            light.SetPosition(*position)
            light.SetFocalPoint(0.0, 0.0, 0.0)
            light.SetIntensity(strength)
            self._renderer.AddLight(light)

    def _build_cloth(self):
        self._normals = vtkPolyDataNormals()
        self._normals.SetFeatureAngle(FEATURE_ANGLE)
        self._normals.SplittingOn()
        self._normals.ConsistencyOff()
        mapper = vtkPolyDataMapper()
        mapper.SetInputConnection(self._normals.GetOutputPort())
        mapper.SetLookupTable(white_to_red())
        mapper.UseLookupTableScalarRangeOff()
        mapper.SetScalarModeToUseCellFieldData()
        self._coloured = material((1.0, 1.0, 1.0), ambient=0.30, diffuse=0.95)
        self._front = material(CLOTH_FRONT, ambient=0.22, diffuse=1.0)
        self._back = material(CLOTH_BACK, ambient=0.22, diffuse=1.0)
        self._cloth = vtkActor()
        self._cloth.SetMapper(mapper)
        self._renderer.AddActor(self._cloth)

        # The outline: without it a fold in front of another of the same colour is lost.
        self._edges = vtkFeatureEdges()
        self._edges.BoundaryEdgesOn()
        self._edges.FeatureEdgesOff()
        self._edges.NonManifoldEdgesOff()
        self._edges.ManifoldEdgesOff()
        self._edges.ColoringOff()
        outline = vtkPolyDataMapper()
        outline.SetInputConnection(self._edges.GetOutputPort())
        outline.ScalarVisibilityOff()
        actor = vtkActor()
        actor.SetMapper(outline)
        actor.SetProperty(material((0.10, 0.11, 0.13), ambient=1.0, diffuse=0.0))
        actor.GetProperty().SetLineWidth(1.2 * SUPERSAMPLING)
        self._renderer.AddActor(actor)


def material(colour, ambient, diffuse):
    surface = vtkProperty()
    surface.SetColor(*colour)
    surface.SetAmbient(ambient)
    surface.SetDiffuse(diffuse)
    surface.SetSpecular(0.0)
    surface.SetInterpolationToPhong()
    return surface


def collider_actor(collider, camera):
    """The collider of a scene file as something to draw, a little inside its surface: cloth rests on the surface
    with its vertices alone, and the middle of a triangle would be hidden. None for a kind not known here."""
    # Defaults are those of the scene file.
    kind, shape = shape_of(collider)
    if kind == "sphere":
        source = sphere(shape.get("center", (0, 0, 0)), INSIDE * shape.get("radius", 0.3))
    elif kind == "capsule":
        source = capsule(shape.get("a", (-0.3, 0, 0)), shape.get("b", (0.3, 0, 0)), INSIDE * shape.get("radius", 0.1))
    elif kind == "plane":
        source = plane(shape.get("point", (0, 0, 0)), shape.get("normal", (0, 1, 0)), camera)
    else:
        return None
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.SetProperty(material(COLLIDER, ambient=0.25, diffuse=0.75))
    return actor


def shape_of(collider):
    """Kind and values of a collider of a scene file."""
    (kind, shape), = ((key, value) for key, value in collider.items() if key != "motion")
    return kind, shape


def carried(collider, time):
    """What the motion of a collider has done to it by `time`, s, as the scene's schema describes it."""
    motion = collider["motion"]
    start = motion.get("start", 0.0)
    seconds = min(max(time, start), motion.get("stop", np.inf)) - start
    transform = vtkTransform()
    if "translate" in motion:
        transform.Translate(*(seconds * np.asarray(motion["translate"].get("velocity", (0, 0, 0)), float)))
    if "rotate" in motion:
        rotation = motion["rotate"]
        kind, shape = shape_of(collider)
        middle = {"sphere": lambda: shape.get("center", (0, 0, 0)), "plane": lambda: shape.get("point", (0, 0, 0)),
                  "capsule": lambda: 0.5 * (np.asarray(shape.get("a", (-0.3, 0, 0)), float)
                                            + np.asarray(shape.get("b", (0.3, 0, 0)), float))}
        center = np.asarray(rotation.get("center", middle[kind]()), float)
        transform.Translate(*center)
        transform.RotateWXYZ(seconds * rotation.get("degrees_per_second", 0.0), *rotation.get("axis", (0, 1, 0)))
        transform.Translate(*-center)
    return transform


def sphere(center, radius):
    source = vtkSphereSource()
    source.SetCenter(*center)
    source.SetRadius(radius)
    source.SetThetaResolution(96)
    source.SetPhiResolution(96)
    return source


def capsule(a, b, radius):
    axis = vtkLineSource()
    axis.SetPoint1(*a)
    axis.SetPoint2(*b)
    barrel = vtkTubeFilter()
    barrel.SetInputConnection(axis.GetOutputPort())
    barrel.SetRadius(radius)
    barrel.SetNumberOfSides(96)
    whole = vtkAppendPolyData()
    for part in (barrel, sphere(a, radius), sphere(b, radius)):
        whole.AddInputConnection(part.GetOutputPort())
    return whole


def plane(point, normal, camera):
    """An endless plane, cut to a disc under the middle of the picture."""
    normal = np.asarray(normal, float) / np.linalg.norm(normal)
    middle = np.asarray(camera.focal_point)
    middle = middle - np.dot(middle - np.asarray(point, float), normal) * normal
    middle -= (1.0 - INSIDE) * camera.scene_radius * normal
    source = vtkRegularPolygonSource()
    source.SetNumberOfSides(256)
    source.SetRadius(0.75 * camera.scene_radius)
    source.SetCenter(*middle)
    source.SetNormal(*normal)
    return source

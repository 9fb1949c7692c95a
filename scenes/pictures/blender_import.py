#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Opens in Blender what `apsl run --out DIR` left: the moving cloth, coloured by its area change.

Inside Blender:      blender --python blender_import.py -- DIR [--save FILE.blend] [--render FILE.png --frame N]
With the module bpy: python blender_import.py DIR --save FILE.blend
Frame numbers are the report's. Needs Blender 3.4 or later.
"""
import argparse
import math
import struct
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

REST_AREA, AREA_CHANGE = "rest_area", "area_change"  # attributes of faces


def import_run(folder, red=0.10):
    """The cloth in `folder` as a new object of the scene. red: the area change |A − A⁰| / A⁰ that is pure red."""
    folder = Path(folder).resolve()
    for name in ("cloth.obj", "cloth.pc2", "cloth.pvd"):
        if not (folder / name).is_file():
            raise FileNotFoundError(f"{folder / name}: no such file; expected what a whole `apsl run --out DIR` leaves")
    bpy.ops.wm.obj_import(filepath=str(folder / "cloth.obj"))  # turns the object, so that its y is Blender's z
    cloth = bpy.context.selected_objects[0]
    store_rest_areas(cloth.data)
    play = cloth.modifiers.new("apsl motion", "MESH_CACHE")
    play.cache_format, play.filepath = "PC2", str(folder / "cloth.pc2")
    measure = cloth.modifiers.new("apsl area change", "NODES")
    measure.node_group = area_change_nodes()
    cloth.data.materials.clear()
    cloth.data.materials.append(white_to_red(red))
    set_time(bpy.context.scene, folder)
    return cloth


def store_rest_areas(mesh):
    # Before any modifier the mesh is the cloth at rest.
    areas = np.empty(len(mesh.polygons), np.float32)
    mesh.polygons.foreach_get("area", areas)
    mesh.attributes.new(REST_AREA, "FLOAT", "FACE").data.foreach_set("value", areas)


def area_change_nodes():
    """Geometry nodes that store |A − A⁰| / A⁰ on the faces as they are in the frame shown."""
    group = bpy.data.node_groups.new("apsl area change", "GeometryNodeTree")
    if hasattr(group, "interface"):
        for direction in ("INPUT", "OUTPUT"):
            group.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    else:  # before Blender 4
        for sockets in (group.inputs, group.outputs):
            sockets.new("NodeSocketGeometry", "Geometry")

    def node(kind, **settings):
        made = group.nodes.new(kind)
        for name, value in settings.items():
            setattr(made, name, value)
        return made

    def math_node(operation, *sources):
        made = node("ShaderNodeMath", operation=operation)
        for socket, source in zip(made.inputs, sources):
            group.links.new(source, socket)
        return made.outputs[0]

    rest = node("GeometryNodeInputNamedAttribute", data_type="FLOAT")
    rest.inputs["Name"].default_value = REST_AREA
    rest_area = next(socket for socket in rest.outputs if socket.enabled and socket.name == "Attribute")
    area = node("GeometryNodeInputMeshFaceArea").outputs[0]
    change = math_node("ABSOLUTE", math_node("DIVIDE", math_node("SUBTRACT", area, rest_area), rest_area))
    store = node("GeometryNodeStoreNamedAttribute", data_type="FLOAT", domain="FACE")
    store.inputs["Name"].default_value = AREA_CHANGE
    value = next(socket for socket in store.inputs if socket.enabled and socket.name == "Value")
    group.links.new(change, value)
    group.links.new(node("NodeGroupInput").outputs[0], store.inputs["Geometry"])
    group.links.new(store.outputs["Geometry"], node("NodeGroupOutput").inputs[0])
    for place, each in enumerate(group.nodes):
        each.location = (200 * place, 0)
    return group


def white_to_red(red):
    material = bpy.data.materials.new("apsl area change")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    attribute = nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = AREA_CHANGE
    scale = nodes.new("ShaderNodeMapRange")  # clamps
    scale.inputs["From Max"].default_value = red
    ramp = nodes.new("ShaderNodeValToRGB")
    for element, colour in zip(ramp.color_ramp.elements, ((1, 1, 1, 1), (1, 0, 0, 1))):
        element.color = colour
    surface = nodes["Principled BSDF"]
    surface.inputs["Roughness"].default_value = 0.9
    links.new(attribute.outputs["Fac"], scale.inputs["Value"])
    links.new(scale.outputs["Result"], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], surface.inputs["Base Color"])
    for place, each in enumerate((attribute, scale, ramp)):
        each.location = (surface.location.x - 900 + 300 * place, surface.location.y)
    return material


def set_time(scene, folder):
    """Frames and seconds of the run. Sample k of the point cache plays in frame k, which is frame k of the report."""
    (samples,) = struct.unpack("<i", (folder / "cloth.pc2").read_bytes()[28:32])
    times = [float(entry.get("timestep")) for entry in ElementTree.parse(folder / "cloth.pvd").iter("DataSet")]
    scene.frame_start, scene.frame_end = 0, max(samples - 1, 0)
    scene.render.fps = max(1, round(1 / times[0]))  # the first frame ends one frame's time after the start
    scene.render.fps_base = scene.render.fps * times[0]
    scene.frame_set(0)


def render(cloth, frame, picture, size=(640, 480), samples=64):
    """A picture of one frame by Cycles on the processor, from the front and a little above."""
    scene = bpy.context.scene
    scene.frame_set(frame)
    evaluated = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get())
    points = np.array([evaluated.matrix_world @ vertex.co for vertex in evaluated.data.vertices])
    centre, radius = (points.min(0) + points.max(0)) / 2, np.linalg.norm(np.ptp(points, axis=0)) / 2
    backward = Vector((0.5, -1.0, 0.35)).normalized()

    camera = bpy.data.objects.new("apsl camera", bpy.data.cameras.new("apsl camera"))
    camera.location = Vector(centre) + backward * (0.9 * radius / math.sin(camera.data.angle_y / 2))
    camera.rotation_euler = backward.to_track_quat("Z", "Y").to_euler()
    sun = bpy.data.objects.new("apsl sun", bpy.data.lights.new("apsl sun", "SUN"))
    sun.rotation_euler = (backward + Vector((-0.6, 0, 0.6))).to_track_quat("Z", "Y").to_euler()  # from the upper left
    sun.data.energy, sun.data.angle = 2.0, 0.1
    world = bpy.data.worlds.new("apsl world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.2, 0.23, 0.27, 1)
    for made in (camera, sun):
        scene.collection.objects.link(made)
    scene.camera, scene.world = camera, world
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples = "CPU", samples
    scene.cycles.use_denoising = False  # Debian's Blender is built without
    scene.view_settings.view_transform, scene.render.dither_intensity = "Standard", 0  # red stays red
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(Path(picture).resolve())
    bpy.ops.render.render(write_still=True)


def main(arguments):
    parser = argparse.ArgumentParser(prog="blender_import.py", description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="DIR", help="what `apsl run --out DIR` wrote")
    parser.add_argument("--red", type=float, default=0.10, help="area change |A − A⁰| / A⁰ that is pure red")
    parser.add_argument("--save", metavar="FILE.blend")
    parser.add_argument("--render", metavar="FILE.png")
    parser.add_argument("--frame", type=int, default=0, help="of --render")
    options = parser.parse_args(arguments)
    for default in [entry for entry in bpy.data.objects if entry.name in ("Cube", "Light", "Camera")]:
        bpy.data.objects.remove(default)
    try:
        cloth = import_run(options.folder, options.red)
    except FileNotFoundError as error:
        sys.exit(f"error: {error}")
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(options.save).resolve()))
    if options.render:
        render(cloth, options.frame, options.render)


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:])

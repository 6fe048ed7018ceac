# blender -b -P open_in_blender.py -- FILE...   Opens each .glb or .obj and prints a line of what Blender sees:
#   FILE: V vertices, T triangles, UV in [low, high], picture WxH COLOURSPACE
import sys

import bpy
import numpy

if "bool" not in numpy.__dict__:
    numpy.bool = bool  # Debian 12's Blender 3.4 asks its newer numpy for it when it reads glTF

for path in sys.argv[sys.argv.index("--") + 1:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if path.endswith(".glb"):
        bpy.ops.import_scene.gltf(filepath=path)
    else:
        bpy.ops.wm.obj_import(filepath=path)
    (mesh,) = [o.data for o in bpy.data.objects if o.type == "MESH"]
    uvs = [c for d in mesh.uv_layers.active.data for c in d.uv]
    (picture,) = [n.image for m in mesh.materials for n in m.node_tree.nodes if n.type == "TEX_IMAGE"]
    linked = any(l.to_socket.name == "Base Color" and l.from_node.type == "TEX_IMAGE"
                 for m in mesh.materials for l in m.node_tree.links)
    print(f"{path}: {len(mesh.vertices)} vertices, {len(mesh.polygons)} triangles, "
          f"UV in [{min(uvs):.4f}, {max(uvs):.4f}], picture {picture.size[0]}x{picture.size[1]} "
          f"{picture.colorspace_settings.name}{'' if linked else ', not the base colour'}")

"""Tables for `python -m creepage from-tables`, from a result of Abaqus with U, V, CNORMF and CSHEARF (or CFORCE, both).

    abaqus python abaqus.py JOB.odb WHEEL RAIL

WHEEL and RAIL are the surfaces of both sides, on bricks with eight nodes. Written from Abaqus's reference, not run in it.
"""

import sys

from abaqusConstants import DOUBLE_PRECISION
from odbAccess import openOdb

# corners of S1 to S6, counter-clockwise from outside
FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
FIRST = {"CNORMF": 0, "CSHEARF": 0, "V": 3, "U": 6}  # the first column of each


def write(name, head, rows):
    with open(name, "w") as file:
        file.write(head + "\n")
        file.writelines(",".join("%.17g" % x for x in row) + "\n" for row in rows)


odb = openOdb(sys.argv[1], readOnly=True)
instances = odb.rootAssembly.instances
# labels are those of an instance
base = {name: 10**7 * k for k, name in enumerate(sorted(instances.keys()))}
faces, used = [], set()
for body, name in enumerate(sys.argv[2:4]):
    surface = odb.rootAssembly.surfaces[name]
    for elements, sides in zip(surface.elements, surface.faces):
        for element, side in zip(elements, sides):
            numbers = [base[of] + n for of, n in zip(element.instanceNames, element.connectivity)]
            faces.append([numbers[k] for k in FACES[int(str(side)[-1]) - 1]] + [body])
            used.update(faces[-1][:4])
write("faces.csv", "n0,n1,n2,n3,body", faces)
nodes = ((base[name] + node.label, node) for name in instances.keys() for node in instances[name].nodes)
write("nodes.csv", "node,x,y,z", ([n] + [float(x) for x in node.coordinates] for n, node in nodes if n in used))
rows = []
for step in odb.steps.values():
    for frame in step.frames:
        found = {n: [0.0] * 9 for n in used}
        for key in frame.fieldOutputs.keys():
            first = FIRST.get(key.split()[0])  # CNORMF has the names of the surfaces after it
            for value in frame.fieldOutputs[key].values if first is not None else ():
                row = found.get(base[value.instance.name] + value.nodeLabel)
                data = value.dataDouble if value.precision == DOUBLE_PRECISION else value.data
                for k in range(3) if row else ():
                    row[first + k] += float(data[k])
        rows += [[float(step.totalTime + frame.frameValue), n] + found[n] for n in sorted(used)]
columns = [name + axis for name in ("force", "velocity", "displacement") for axis in ("_x", "_y", "_z")]
write("values.csv", ",".join(["time", "node"] + columns), rows)

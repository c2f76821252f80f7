"""All of frankik's answers for sampled values of the Panda's seventh joint; runs in frankik's own environment.

python franka_families.py IN.npz OUT.npz: from placements (N, 4, 4) of panda_link8 and q7 (M,), to answers (K, 7) and
the indices (K,) of their placements.
"""

from __future__ import annotations

import sys

import numpy as np
from frankik import ik_full, kQDefault

with np.load(sys.argv[1]) as asked:
    places, sevenths = asked["places"], asked["sevenths"]
answers, owners = [], []
for number, place in enumerate(places):
    for seventh in sevenths:
        for q in ik_full(place, kQDefault, seventh, is_fr3=False):
            if not np.isnan(q).any():
                answers.append(q)
                owners.append(number)
np.savez(sys.argv[2], answers=np.array(answers).reshape(-1, 7), owners=np.array(owners, dtype=int))

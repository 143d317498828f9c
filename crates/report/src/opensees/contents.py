

def contents(tag, k_init):
    """Masses on the floors; friction as an elastic, perfectly plastic spring."""
    for i, (floor, mass, friction) in enumerate(CONTENTS):
        own = 2 + len(MASSES) + i
        node(own, mass, 1)
        between(tag + i, 2 + floor, own, "ElasticPP", k_init, friction * mass * GRAVITY / k_init)

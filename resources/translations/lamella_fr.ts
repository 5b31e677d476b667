<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="fr">
<context>
    <name>Language</name>
    <message>
        <source>that of the system</source>
        <translation>celle du système</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Annuler</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>Fermer</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>Ne pas enregistrer</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Enregistrer</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Actions</name>
    <message>
        <source>&amp;Open…</source>
        <translation>&amp;Ouvrir…</translation>
    </message>
    <message>
        <source>&amp;Add body…</source>
        <translation>&amp;Ajouter un corps…</translation>
    </message>
    <message>
        <source>&amp;Save study</source>
        <translation>&amp;Enregistrer l&apos;étude</translation>
    </message>
    <message>
        <source>Save the study, its mesh and its report in one file</source>
        <translation>Enregistrer l&apos;étude, son maillage et son rapport en un fichier</translation>
    </message>
    <message>
        <source>Save study &amp;as…</source>
        <translation>Enregistrer l&apos;étude so&amp;us…</translation>
    </message>
    <message>
        <source>Save the study under another name</source>
        <translation>Enregistrer l&apos;étude sous un autre nom</translation>
    </message>
    <message>
        <source>&amp;Remove</source>
        <translation>&amp;Supprimer</translation>
    </message>
    <message>
        <source>Remove what is selected in the study</source>
        <translation>Supprimer ce qui est sélectionné dans l&apos;étude</translation>
    </message>
    <message>
        <source>&amp;Export mesh…</source>
        <translation>E&amp;xporter le maillage…</translation>
    </message>
    <message>
        <source>Write the shown mesh for a solver</source>
        <translation>Écrire le maillage affiché pour un solveur</translation>
    </message>
    <message>
        <source>Save &amp;picture…</source>
        <translation>Enregistrer une &amp;image…</translation>
    </message>
    <message>
        <source>Save the 3D view as a picture of any resolution</source>
        <translation>Enregistrer la vue 3D en image, à la résolution voulue</translation>
    </message>
    <message>
        <source>&amp;Copy as command line</source>
        <translation>&amp;Copier en ligne de commande</translation>
    </message>
    <message>
        <source>Copy the lamella-cli command that makes the same mesh</source>
        <translation>Copier la commande lamella-cli qui produit le même maillage</translation>
    </message>
    <message>
        <source>P&amp;references</source>
        <translation>P&amp;références</translation>
    </message>
    <message>
        <source>&amp;Quit</source>
        <translation>&amp;Quitter</translation>
    </message>
    <message>
        <source>&amp;Undo</source>
        <translation>A&amp;nnuler</translation>
    </message>
    <message>
        <source>&amp;Redo</source>
        <translation>Ré&amp;tablir</translation>
    </message>
    <message>
        <source>&amp;Run</source>
        <translation>&amp;Lancer</translation>
    </message>
    <message>
        <source>Make the mesh</source>
        <translation>Créer le maillage</translation>
    </message>
    <message>
        <source>Pa&amp;use</source>
        <translation>Pa&amp;use</translation>
    </message>
    <message>
        <source>Hold the run and leave the processors to others; once more goes on</source>
        <translation>Suspendre le calcul et laisser les processeurs à d&apos;autres ; une seconde fois le reprend</translation>
    </message>
    <message>
        <source>&amp;Cancel</source>
        <translation>&amp;Arrêter</translation>
    </message>
    <message>
        <source>Stop and keep the best mesh so far</source>
        <translation>Arrêter et garder le meilleur maillage obtenu</translation>
    </message>
    <message>
        <source>&amp;Forecast</source>
        <translation>Pré&amp;vision</translation>
    </message>
    <message>
        <source>Tell the nodes and the memory to expect, without meshing</source>
        <translation>Prévoir les nœuds et la mémoire, sans mailler</translation>
    </message>
    <message>
        <source>Find &amp;overlaps and gaps</source>
        <translation>Chercher &amp;recouvrements et jeux</translation>
    </message>
    <message>
        <source>Look where bodies overlap, and where they leave gaps between them</source>
        <translation>Chercher où des corps se recouvrent, et où ils laissent des jeux entre eux</translation>
    </message>
    <message>
        <source>Add boundary &amp;group</source>
        <translation>Ajouter un &amp;groupe de frontière</translation>
    </message>
    <message>
        <source>Name a part of the boundary: gate, vent, symmetry</source>
        <translation>Nommer une partie de la frontière : seuil, évent, symétrie</translation>
    </message>
    <message>
        <source>Body by formula: &amp;ball</source>
        <translation>Corps par formule : &amp;boule</translation>
    </message>
    <message>
        <source>A body that needs no file; it is meshed in one mesh of all bodies</source>
        <translation>Un corps qui n&apos;a pas besoin de fichier ; il est maillé avec tous les corps en un seul maillage</translation>
    </message>
    <message>
        <source>Body by formula: b&amp;ox</source>
        <translation>Corps par formule : b&amp;oîte</translation>
    </message>
    <message>
        <source>Body by formula: &amp;cylinder</source>
        <translation>Corps par formule : &amp;cylindre</translation>
    </message>
    <message>
        <source>Body by formula: &amp;half-space</source>
        <translation>Corps par formule : &amp;demi-espace</translation>
    </message>
    <message>
        <source>What is on one side of a plane, as far as the domain reaches</source>
        <translation>Ce qui est d&apos;un côté d&apos;un plan, aussi loin que va le domaine</translation>
    </message>
    <message>
        <source>Add a &amp;sphere with a size of its own</source>
        <translation>Ajouter une &amp;sphère ayant sa propre taille</translation>
    </message>
    <message>
        <source>Add a &amp;box with a size of its own</source>
        <translation>Ajouter une &amp;boîte ayant sa propre taille</translation>
    </message>
    <message>
        <source>Add a c&amp;ylinder with a size of its own</source>
        <translation>Ajouter un c&amp;ylindre ayant sa propre taille</translation>
    </message>
    <message>
        <source>&amp;Pick faces of the group</source>
        <translation>&amp;Désigner les faces du groupe</translation>
    </message>
    <message>
        <source>Click faces to add them to the selected group, or to take them out</source>
        <translation>Cliquer des faces pour les ajouter au groupe sélectionné, ou pour les en retirer</translation>
    </message>
    <message>
        <source>&amp;Flood from a point</source>
        <translation>&amp;Inonder depuis un point</translation>
    </message>
    <message>
        <source>Click where the group is to begin: it spreads until the surface turns</source>
        <translation>Cliquer où le groupe doit commencer : il s&apos;étend jusqu&apos;à ce que la surface tourne</translation>
    </message>
    <message>
        <source>Correct &amp;near a point</source>
        <translation>Corriger &amp;près d&apos;un point</translation>
    </message>
    <message>
        <source>Click a place, such as the gate: a sphere with a size of its own is put there</source>
        <translation>Cliquer un endroit, comme le seuil : une sphère ayant sa propre taille y est posée</translation>
    </message>
    <message>
        <source>Correct on a &amp;face</source>
        <translation>Corriger sur une &amp;face</translation>
    </message>
    <message>
        <source>Click a CAD face that is to have a size of its own</source>
        <translation>Cliquer une face CAO qui doit avoir sa propre taille</translation>
    </message>
    <message>
        <source>&amp;Measure distances</source>
        <translation>&amp;Mesurer des distances</translation>
    </message>
    <message>
        <source>Click two places to see their distance; a third click begins anew</source>
        <translation>Cliquer deux endroits pour voir leur distance ; un troisième clic recommence</translation>
    </message>
    <message>
        <source>Show the metric at a &amp;click</source>
        <translation>Montrer la métrique d&apos;un &amp;clic</translation>
    </message>
    <message>
        <source>Click the mesh to see the element sizes asked there, as an ellipsoid</source>
        <translation>Cliquer le maillage pour voir les tailles d&apos;éléments demandées là, en ellipsoïde</translation>
    </message>
    <message>
        <source>&amp;Zoom to a box</source>
        <translation>&amp;Zoom sur un rectangle</translation>
    </message>
    <message>
        <source>Draw a rectangle to bring it close</source>
        <translation>Tracer un rectangle pour l&apos;approcher</translation>
    </message>
    <message>
        <source>&amp;Section</source>
        <translation>&amp;Coupe</translation>
    </message>
    <message>
        <source>Cut the model open with a plane you can drag</source>
        <translation>Ouvrir le modèle par un plan que l&apos;on tire</translation>
    </message>
    <message>
        <source>Section across X</source>
        <translation>Coupe perpendiculaire à X</translation>
    </message>
    <message>
        <source>Section across Y</source>
        <translation>Coupe perpendiculaire à Y</translation>
    </message>
    <message>
        <source>Section across Z</source>
        <translation>Coupe perpendiculaire à Z</translation>
    </message>
    <message>
        <source>&amp;Flip section</source>
        <translation>&amp;Inverser la coupe</translation>
    </message>
    <message>
        <source>Show the other side of the section</source>
        <translation>Montrer l&apos;autre côté de la coupe</translation>
    </message>
    <message>
        <source>&amp;Another section</source>
        <translation>Une &amp;autre coupe</translation>
    </message>
    <message>
        <source>Cut with one more plane</source>
        <translation>Couper par un plan de plus</translation>
    </message>
    <message>
        <source>Cut by &amp;whole elements</source>
        <translation>Couper par éléments &amp;entiers</translation>
    </message>
    <message>
        <source>Leave whole elements at the section instead of cutting through them</source>
        <translation>Laisser les éléments entiers à la coupe au lieu de les traverser</translation>
    </message>
    <message>
        <source>Mesh &amp;edges</source>
        <translation>&amp;Arêtes du maillage</translation>
    </message>
    <message>
        <source>Show the edges of the elements</source>
        <translation>Montrer les arêtes des éléments</translation>
    </message>
    <message>
        <source>Feature e&amp;dges</source>
        <translation>A&amp;rêtes vives</translation>
    </message>
    <message>
        <source>Show the edges of the CAD model</source>
        <translation>Montrer les arêtes du modèle CAO</translation>
    </message>
    <message>
        <source>F&amp;it</source>
        <translation>T&amp;out voir</translation>
    </message>
    <message>
        <source>See everything</source>
        <translation>Tout voir</translation>
    </message>
    <message>
        <source>&amp;Perspective</source>
        <translation>&amp;Perspective</translation>
    </message>
    <message>
        <source>Perspective instead of parallel projection</source>
        <translation>Perspective au lieu de projection parallèle</translation>
    </message>
    <message>
        <source>Two views side b&amp;y side</source>
        <translation>Deux vues côte à cô&amp;te</translation>
    </message>
    <message>
        <source>Show another iteration beside this one, with the same camera and cuts</source>
        <translation>Montrer une autre itération à côté de celle-ci, avec la même caméra et les mêmes coupes</translation>
    </message>
    <message>
        <source>Isometric</source>
        <translation>Isométrique</translation>
    </message>
    <message>
        <source>Isometric view</source>
        <translation>Vue isométrique</translation>
    </message>
    <message>
        <source>Front</source>
        <translation>Avant</translation>
    </message>
    <message>
        <source>Back</source>
        <translation>Arrière</translation>
    </message>
    <message>
        <source>Left</source>
        <translation>Gauche</translation>
    </message>
    <message>
        <source>Right</source>
        <translation>Droite</translation>
    </message>
    <message>
        <source>Top</source>
        <translation>Dessus</translation>
    </message>
    <message>
        <source>Bottom</source>
        <translation>Dessous</translation>
    </message>
    <message>
        <source>&amp;Study</source>
        <translation>&amp;Étude</translation>
    </message>
    <message>
        <source>&amp;Properties</source>
        <translation>&amp;Propriétés</translation>
    </message>
    <message>
        <source>&amp;Convergence, report and log</source>
        <translation>&amp;Convergence, rapport et journal</translation>
    </message>
    <message>
        <source>&amp;Search actions…</source>
        <translation>&amp;Chercher une action…</translation>
    </message>
    <message>
        <source>Find any action by its name</source>
        <translation>Trouver une action par son nom</translation>
    </message>
    <message>
        <source>&amp;Keyboard shortcuts</source>
        <translation>&amp;Raccourcis clavier</translation>
    </message>
    <message>
        <source>&amp;Journal</source>
        <translation>&amp;Journal des actions</translation>
    </message>
    <message>
        <source>What was done, line by line, in this window and in one that crashed</source>
        <translation>Ce qui a été fait, ligne à ligne, dans cette fenêtre et dans celle qui s&apos;est arrêtée</translation>
    </message>
    <message>
        <source>&amp;About Lamella</source>
        <translation>À &amp;propos de Lamella</translation>
    </message>
    <message>
        <source>Theme, language, unit, memory, threads</source>
        <translation>Thème, langue, unité, mémoire, processeurs</translation>
    </message>
    <message>
        <source>&amp;Solve the flow</source>
        <translation>&amp;Résoudre l&apos;écoulement</translation>
    </message>
    <message>
        <source>Solve the flow between gates and vents through the mesh that is shown</source>
        <translation>Résoudre l&apos;écoulement entre seuils et évents à travers le maillage affiché</translation>
    </message>
    <message>
        <source>Flow &amp;arrows</source>
        <translation>&amp;Flèches de l&apos;écoulement</translation>
    </message>
    <message>
        <source>Show the flow as arrows, on the section or within the mesh</source>
        <translation>Montrer l&apos;écoulement par des flèches, sur la coupe ou dans le maillage</translation>
    </message>
    <message>
        <source>Stream&amp;lines</source>
        <translation>&amp;Lignes de courant</translation>
    </message>
    <message>
        <source>Show the ways of the fluid from the gates</source>
        <translation>Montrer les chemins du fluide depuis les seuils</translation>
    </message>
    <message>
        <source>Le&amp;vel sets</source>
        <translation>Lignes de ni&amp;veau</translation>
    </message>
    <message>
        <source>Show lines of equal velocity on the section, or of equal pressure</source>
        <translation>Montrer les lignes de même vitesse sur la coupe, ou de même pression</translation>
    </message>
    <message>
        <source>Save repor&amp;t…</source>
        <translation>Enregistrer le rappor&amp;t…</translation>
    </message>
    <message>
        <source>Save the report of the run as PDF or HTML</source>
        <translation>Enregistrer le rapport du calcul en PDF ou en HTML</translation>
    </message>
    <message>
        <source>Open a study, a CAD file or an STL file</source>
        <translation>Ouvrir une étude, un fichier CAO ou STL</translation>
    </message>
    <message>
        <source>Re&amp;load the parts</source>
        <translation>Re&amp;charger les pièces</translation>
    </message>
    <message>
        <source>Read the files of the parts again; settings, groups and sizes stay</source>
        <translation>Relire les fichiers des pièces ; réglages, groupes et tailles restent</translation>
    </message>
    <message>
        <source>Add the bodies of another file, be it CAD, an STL or a mesh</source>
        <translation>Ajouter les corps d’un autre fichier : CAO, STL ou maillage</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Banner</name>
    <message>
        <source>Dismiss</source>
        <translation>Fermer</translation>
    </message>
</context>
<context>
    <name>lamella::ui::BodyPage</name>
    <message>
        <source>What the body is in the tool. It gives the body its color and its layers,
and tells who keeps what bodies share in one mesh of all: inserts before
cavities and channels, and these before the mold</source>
        <translation>Ce qu&apos;est le corps dans l&apos;outillage. Cela lui donne sa couleur et ses couches,
et dit qui garde ce que des corps partagent en un seul maillage : les inserts
avant les empreintes et les canaux, et ceux-ci avant le moule</translation>
    </message>
    <message>
        <source>Role</source>
        <translation>Rôle</translation>
    </message>
    <message>
        <source>Walls</source>
        <translation>Parois</translation>
    </message>
    <message>
        <source>n: elements through the wall, everywhere</source>
        <translation>n : éléments à travers la paroi, partout</translation>
    </message>
    <message>
        <source>Layers n</source>
        <translation>Couches n</translation>
    </message>
    <message>
        <source>Directions up to (1 + α) times the wall thickness are divided into n elements too; longer ones are left coarse</source>
        <translation>Les directions jusqu&apos;à (1 + α) fois l&apos;épaisseur de la paroi sont aussi divisées en n éléments ; les plus longues restent grossières</translation>
    </message>
    <message>
        <source>Stretch limit α</source>
        <translation>Limite d&apos;étirement α</translation>
    </message>
    <message>
        <source>No element is asked to be thinner; needed where walls end in a blade. Empty: automatic</source>
        <translation>Aucun élément n&apos;est demandé plus mince ; utile où les parois finissent en lame. Vide : automatique</translation>
    </message>
    <message>
        <source>Smallest size</source>
        <translation>Taille minimale</translation>
    </message>
    <message>
        <source>No element is asked to be longer. Empty: no bound</source>
        <translation>Aucun élément n&apos;est demandé plus long. Vide : sans limite</translation>
    </message>
    <message>
        <source>Largest size</source>
        <translation>Taille maximale</translation>
    </message>
    <message>
        <source>Across the borders of the body in one mesh of all bodies; of two
bodies the smaller counts. Empty: automatic</source>
        <translation>À travers les frontières du corps en un seul maillage de tous les corps ; de deux
corps, le plus petit compte. Vide : automatique</translation>
    </message>
    <message>
        <source>Interface size</source>
        <translation>Taille d&apos;interface</translation>
    </message>
    <message>
        <source>Width and length</source>
        <translation>Largeur et longueur</translation>
    </message>
    <message>
        <source>n2: elements through the width of a wall, for channels and ribs.
It needs to be told up to which width: see α2</source>
        <translation>n2 : éléments à travers la largeur d&apos;une paroi, pour canaux et nervures.
Il faut dire jusqu&apos;à quelle largeur : voir α2</translation>
    </message>
    <message>
        <source>Through width n2</source>
        <translation>Sur la largeur n2</translation>
    </message>
    <message>
        <source>Sizes up to (1 + α + α2) times the thickness count as width</source>
        <translation>Les tailles jusqu&apos;à (1 + α + α2) fois l&apos;épaisseur comptent comme largeur</translation>
    </message>
    <message>
        <source>Width limit α2</source>
        <translation>Limite de largeur α2</translation>
    </message>
    <message>
        <source>n3: elements along all longer directions</source>
        <translation>n3 : éléments le long de toutes les directions plus longues</translation>
    </message>
    <message>
        <source>Along length n3</source>
        <translation>Sur la longueur n3</translation>
    </message>
    <message>
        <source>Color…</source>
        <translation>Couleur…</translation>
    </message>
    <message>
        <source>Color of the selected bodies in the view</source>
        <translation>Couleur des corps sélectionnés dans la vue</translation>
    </message>
    <message>
        <source>Layers</source>
        <translation>Couches</translation>
    </message>
    <message>
        <source>α</source>
        <translation>α</translation>
    </message>
    <message>
        <source>n2</source>
        <translation>n2</translation>
    </message>
    <message>
        <source>α2</source>
        <translation>α2</translation>
    </message>
    <message>
        <source>n3</source>
        <translation>n3</translation>
    </message>
    <message>
        <source>Color</source>
        <translation>Couleur</translation>
    </message>
    <message>
        <source>No body selected</source>
        <translation>Aucun corps sélectionné</translation>
    </message>
    <message>
        <source>%1 bodies</source>
        <translation>%1 corps</translation>
    </message>
    <message>
        <source>Volume %1</source>
        <translation>Volume %1</translation>
    </message>
    <message>
        <source>A body by formula&lt;br&gt;</source>
        <translation>Un corps par formule&lt;br&gt;</translation>
    </message>
    <message>
        <source>What is around the bodies in the domain</source>
        <translation>Ce qui entoure les corps dans le domaine</translation>
    </message>
    <message>
        <source>auto: %1</source>
        <translation>auto : %1</translation>
    </message>
    <message>
        <source>no bound</source>
        <translation>sans limite</translation>
    </message>
    <message>
        <source>auto: 1/4 of a layer</source>
        <translation>auto : 1/4 de couche</translation>
    </message>
    <message>
        <source>different</source>
        <translation>différents</translation>
    </message>
    <message>
        <source>as the length</source>
        <translation>comme la longueur</translation>
    </message>
    <message>
        <source>none</source>
        <translation>aucune</translation>
    </message>
    <message>
        <source>not divided</source>
        <translation>non divisée</translation>
    </message>
    <message>
        <source>corrects the mesh</source>
        <translation>corrige le maillage</translation>
    </message>
    <message>
        <source>The flow through its gates may refine this body</source>
        <translation>L&apos;écoulement par ses seuils peut raffiner ce corps</translation>
    </message>
    <message>
        <source>Flow</source>
        <translation>Écoulement</translation>
    </message>
    <message>
        <source>Flow through a body</source>
        <translation>Écoulement à travers un corps</translation>
    </message>
    <message>
        <source>auto: as the layers</source>
        <translation>auto : comme les couches</translation>
    </message>
    <message>
        <source>%1&lt;br&gt;Volume %2&lt;br&gt;%3, %L4 triangles</source>
        <translation>%1&lt;br&gt;Volume %2&lt;br&gt;%3, %L4 triangles</translation>
    </message>
    <message>
        <source>1 face</source>
        <translation>1 face</translation>
    </message>
    <message>
        <source>%L1 faces</source>
        <translation>%L1 faces</translation>
    </message>
    <message>
        <source>auto: %1–%2</source>
        <translation>auto : %1–%2</translation>
    </message>
</context>
<context>
    <name>lamella::ui::CompareView</name>
    <message>
        <source>Compared with</source>
        <translation>Comparée à</translation>
    </message>
    <message>
        <source>Iteration on the left</source>
        <translation>Itération de gauche</translation>
    </message>
    <message>
        <source>The iteration on the left; the one on the right is that of the slider</source>
        <translation>L&apos;itération de gauche ; celle de droite est celle du curseur</translation>
    </message>
    <message>
        <source>the iteration before</source>
        <translation>l&apos;itération d&apos;avant</translation>
    </message>
    <message>
        <source>0: first mesh</source>
        <translation>0 : premier maillage</translation>
    </message>
    <message>
        <source>iteration %1</source>
        <translation>itération %1</translation>
    </message>
</context>
<context>
    <name>lamella::ui::ConvergencePanel</name>
    <message>
        <source>Nodes</source>
        <translation>Nœuds</translation>
    </message>
    <message>
        <source>Iteration</source>
        <translation>Itération</translation>
    </message>
    <message>
        <source>Previous iteration</source>
        <translation>Itération précédente</translation>
    </message>
    <message>
        <source>Next iteration</source>
        <translation>Itération suivante</translation>
    </message>
    <message>
        <source>Logarithmic nodes</source>
        <translation>Nœuds en logarithme</translation>
    </message>
    <message>
        <source>Save the figures of all iterations as a table or as a picture</source>
        <translation>Enregistrer les valeurs de toutes les itérations en tableau ou en image</translation>
    </message>
    <message>
        <source>Save figures</source>
        <translation>Enregistrer les valeurs</translation>
    </message>
    <message>
        <source>nodes</source>
        <translation>nœuds</translation>
    </message>
    <message>
        <source>mean</source>
        <translation>moyenne</translation>
    </message>
    <message>
        <source>conformity</source>
        <translation>conformité</translation>
    </message>
    <message>
        <source>mixed</source>
        <translation>mixtes</translation>
    </message>
    <message>
        <source>interface error</source>
        <translation>erreur d&apos;interface</translation>
    </message>
    <message>
        <source>Layers, all bodies</source>
        <translation>Couches, tous les corps</translation>
    </message>
    <message>
        <source>Layers, %1</source>
        <translation>Couches, %1</translation>
    </message>
    <message>
        <source>Layers</source>
        <translation>Couches</translation>
    </message>
    <message>
        <source>5 %</source>
        <translation>5 %</translation>
    </message>
    <message>
        <source>asked</source>
        <translation>demandées</translation>
    </message>
    <message>
        <source>no mesh yet</source>
        <translation>pas encore de maillage</translation>
    </message>
    <message>
        <source>opened mesh</source>
        <translation>maillage ouvert</translation>
    </message>
    <message>
        <source>0: first mesh</source>
        <translation>0 : premier maillage</translation>
    </message>
    <message>
        <source>  (latest)</source>
        <translation>  (dernière)</translation>
    </message>
    <message>
        <source>Measured through the walls: the mean, and what 5 % of the wall area fall below</source>
        <translation>Mesurées à travers les parois : la moyenne, et la valeur que 5 % de la surface des parois n’atteignent pas</translation>
    </message>
    <message>
        <source>Conformity</source>
        <translation>Conformité</translation>
    </message>
    <message>
        <source>How far elements are from what the metric asks, 0 is perfect</source>
        <translation>Écart des éléments à ce que demande la métrique, 0 est parfait</translation>
    </message>
    <message>
        <source>Worst quality</source>
        <translation>Pire qualité</translation>
    </message>
    <message>
        <source>Of all elements by c(T), 1 is best</source>
        <translation>De tous les éléments, par c(T), 1 est le mieux</translation>
    </message>
    <message>
        <source>Interface L2</source>
        <translation>Interface L2</translation>
    </message>
    <message>
        <source>L2 error of the filling ratio, relative to the body: the largest of all bodies</source>
        <translation>Erreur L2 du taux de remplissage, rapportée au corps : la plus grande de tous les corps</translation>
    </message>
    <message>
        <source>worst quality</source>
        <translation>pire qualité</translation>
    </message>
    <message>
        <source>A project keeps the last mesh alone</source>
        <translation>Un projet ne garde que le dernier maillage</translation>
    </message>
</context>
<context>
    <name>lamella::ui::CutPage</name>
    <message>
        <source>Cut</source>
        <translation>Coupe</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Nom</translation>
    </message>
    <message>
        <source>A point of the plane</source>
        <translation>Un point du plan</translation>
    </message>
    <message>
        <source>Through</source>
        <translation>Par</translation>
    </message>
    <message>
        <source>Across the plane: what it points to is cut away</source>
        <translation>Perpendiculaire au plan : ce vers quoi il pointe est enlevé</translation>
    </message>
    <message>
        <source>Towards</source>
        <translation>Vers</translation>
    </message>
    <message>
        <source>In the view the blue knob moves the plane, the orange tip turns it.</source>
        <translation>Dans la vue, le bouton bleu déplace le plan, la pointe orange le tourne.</translation>
    </message>
    <message>
        <source>Rename %1</source>
        <translation>Renommer %1</translation>
    </message>
    <message>
        <source>Move %1</source>
        <translation>Déplacer %1</translation>
    </message>
</context>
<context>
    <name>lamella::ui::DomainForm</name>
    <message>
        <source>One for each body: every body alone, as if the others were not
there. One of all bodies: their meshes fit together.</source>
        <translation>Un par corps : chaque corps seul, comme si les autres n&apos;étaient
pas là. Un de tous les corps : leurs maillages s&apos;accordent.</translation>
    </message>
    <message>
        <source>one of all bodies</source>
        <translation>un pour tous</translation>
    </message>
    <message>
        <source>Meshes</source>
        <translation>Maillages</translation>
    </message>
    <message>
        <source>What the mesh of all bodies fills</source>
        <translation>Ce que remplit le maillage de tous les corps</translation>
    </message>
    <message>
        <source>the bodies alone</source>
        <translation>les corps seuls</translation>
    </message>
    <message>
        <source>box with a margin</source>
        <translation>boîte et marge</translation>
    </message>
    <message>
        <source>one of the bodies</source>
        <translation>un des corps</translation>
    </message>
    <message>
        <source>box by corners</source>
        <translation>boîte par ses coins</translation>
    </message>
    <message>
        <source>cylinder</source>
        <translation>cylindre</translation>
    </message>
    <message>
        <source>Domain</source>
        <translation>Domaine</translation>
    </message>
    <message>
        <source>Around the box of all bodies on every side, as a share of its diagonal</source>
        <translation>Autour de la boîte de tous les corps, de chaque côté, en part de sa diagonale</translation>
    </message>
    <message>
        <source> %</source>
        <translation> %</translation>
    </message>
    <message>
        <source>Margin</source>
        <translation>Marge</translation>
    </message>
    <message>
        <source>The body that the others are in</source>
        <translation>Le corps dans lequel sont les autres</translation>
    </message>
    <message>
        <source>Inside of</source>
        <translation>Intérieur de</translation>
    </message>
    <message>
        <source>Lower corner</source>
        <translation>Coin inférieur</translation>
    </message>
    <message>
        <source>From corner</source>
        <translation>Du coin</translation>
    </message>
    <message>
        <source>Upper corner</source>
        <translation>Coin supérieur</translation>
    </message>
    <message>
        <source>To corner</source>
        <translation>Au coin</translation>
    </message>
    <message>
        <source>Middle of one end</source>
        <translation>Milieu d&apos;une extrémité</translation>
    </message>
    <message>
        <source>From</source>
        <translation>De</translation>
    </message>
    <message>
        <source>Middle of the other end</source>
        <translation>Milieu de l&apos;autre extrémité</translation>
    </message>
    <message>
        <source>To</source>
        <translation>À</translation>
    </message>
    <message>
        <source>Radius of the cylinder</source>
        <translation>Rayon du cylindre</translation>
    </message>
    <message>
        <source>Radius</source>
        <translation>Rayon</translation>
    </message>
    <message>
        <source>Exact: borders between bodies lie on faces of the mesh.
Fuzzy: they run through thin elements, each filled in
part by several bodies.</source>
        <translation>Exactes : les frontières entre corps sont sur des faces du maillage.
Floues : elles traversent des éléments minces, remplis chacun
en partie par plusieurs corps.</translation>
    </message>
    <message>
        <source>exact</source>
        <translation>exactes</translation>
    </message>
    <message>
        <source>fuzzy</source>
        <translation>floues</translation>
    </message>
    <message>
        <source>Interfaces</source>
        <translation>Interfaces</translation>
    </message>
    <message>
        <source>What draws the mesh together at the borders: the distance to
them, or the gradient of the filling ratio as in the thesis</source>
        <translation>Ce qui resserre le maillage aux frontières : la distance à
elles, ou le gradient du taux de remplissage comme dans la thèse</translation>
    </message>
    <message>
        <source>by distance</source>
        <translation>par distance</translation>
    </message>
    <message>
        <source>by gradient</source>
        <translation>par gradient</translation>
    </message>
    <message>
        <source>Drawn to them</source>
        <translation>Resserré</translation>
    </message>
    <message>
        <source>One mesh for each body</source>
        <translation>Un maillage par corps</translation>
    </message>
    <message>
        <source>One mesh of all bodies</source>
        <translation>Un maillage de tous les corps</translation>
    </message>
    <message>
        <source>Margin of the domain</source>
        <translation>Marge du domaine</translation>
    </message>
    <message>
        <source>Body that is the domain</source>
        <translation>Corps qui est le domaine</translation>
    </message>
    <message>
        <source>Fuzzy interfaces</source>
        <translation>Interfaces floues</translation>
    </message>
    <message>
        <source>Exact interfaces</source>
        <translation>Interfaces exactes</translation>
    </message>
    <message>
        <source>Capture of interfaces</source>
        <translation>Capture des interfaces</translation>
    </message>
    <message>
        <source>Corners of the domain</source>
        <translation>Coins du domaine</translation>
    </message>
    <message>
        <source>Cylinder of the domain</source>
        <translation>Cylindre du domaine</translation>
    </message>
    <message>
        <source>one per body</source>
        <translation>un par corps</translation>
    </message>
</context>
<context>
    <name>lamella::ui::DomainPage</name>
    <message>
        <source>Domain</source>
        <translation>Domaine</translation>
    </message>
    <message>
        <source>One mesh fills it and carries all bodies. Where bodies overlap, the one that comes first in the study keeps what they share.</source>
        <translation>Un maillage le remplit et porte tous les corps. Où des corps se recouvrent, celui qui vient le premier dans l&apos;étude garde ce qu&apos;ils partagent.</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Edits</name>
    <message>
        <source>Gate</source>
        <translation>Seuil</translation>
    </message>
    <message>
        <source>Vent</source>
        <translation>Évent</translation>
    </message>
    <message>
        <source>Symmetry</source>
        <translation>Symétrie</translation>
    </message>
    <message>
        <source>Walls</source>
        <translation>Parois</translation>
    </message>
    <message>
        <source>Other</source>
        <translation>Autre</translation>
    </message>
    <message>
        <source>cavity</source>
        <translation>empreinte</translation>
    </message>
    <message>
        <source>channel</source>
        <translation>canal</translation>
    </message>
    <message>
        <source>insert</source>
        <translation>insert</translation>
    </message>
    <message>
        <source>mold</source>
        <translation>moule</translation>
    </message>
    <message>
        <source>not said</source>
        <translation>non précisé</translation>
    </message>
    <message>
        <source>Add group %1</source>
        <translation>Ajouter le groupe %1</translation>
    </message>
    <message>
        <source>Add size %1</source>
        <translation>Ajouter la taille %1</translation>
    </message>
    <message>
        <source>Cut</source>
        <translation>Coupe</translation>
    </message>
    <message>
        <source>Add %1</source>
        <translation>Ajouter %1</translation>
    </message>
    <message>
        <source>Rename %1</source>
        <translation>Renommer %1</translation>
    </message>
    <message>
        <source>Show all bodies</source>
        <translation>Montrer tous les corps</translation>
    </message>
    <message>
        <source>Inside of %1</source>
        <translation>Intérieur de %1</translation>
    </message>
    <message>
        <source>Box</source>
        <translation>Boîte</translation>
    </message>
    <message>
        <source>Cylinder</source>
        <translation>Cylindre</translation>
    </message>
    <message>
        <source>The bodies alone</source>
        <translation>Les corps seuls</translation>
    </message>
    <message>
        <source>Take a face out of %1</source>
        <translation>Retirer une face de %1</translation>
    </message>
    <message>
        <source>Add a face to %1</source>
        <translation>Ajouter une face à %1</translation>
    </message>
    <message>
        <source>Box, margin %1 %</source>
        <translation>Boîte, marge %1 %</translation>
    </message>
    <message>
        <source>near %1</source>
        <translation>près de %1</translation>
    </message>
</context>
<context>
    <name>lamella::ui::ExportDialog</name>
    <message>
        <source>Export mesh</source>
        <translation>Exporter le maillage</translation>
    </message>
    <message>
        <source>Format</source>
        <translation>Format</translation>
    </message>
    <message>
        <source>millimeters</source>
        <translation>millimètres</translation>
    </message>
    <message>
        <source>meters</source>
        <translation>mètres</translation>
    </message>
    <message>
        <source>Lengths in</source>
        <translation>Longueurs en</translation>
    </message>
    <message>
        <source>Browse…</source>
        <translation>Parcourir…</translation>
    </message>
    <message>
        <source>File</source>
        <translation>Fichier</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>Exporter</translation>
    </message>
    <message>
        <source>This format knows no other unit</source>
        <translation>Ce format ne connaît pas d&apos;autre unité</translation>
    </message>
    <message>
        <source>The triangles of the boundary alone, without any names.</source>
        <translation>Seulement les triangles de la frontière, sans aucun nom.</translation>
    </message>
    <message>
        <source>bodies</source>
        <translation>corps</translation>
    </message>
    <message>
        <source>groups</source>
        <translation>groupes</translation>
    </message>
    <message>
        <source>filling ratios</source>
        <translation>taux de remplissage</translation>
    </message>
    <message>
        <source>metric</source>
        <translation>métrique</translation>
    </message>
    <message>
        <source>The file holds nodes and elements.</source>
        <translation>Le fichier contient les nœuds et les éléments.</translation>
    </message>
    <message>
        <source>In the file: %1.</source>
        <translation>Dans le fichier : %1.</translation>
    </message>
    <message>
        <source>Beside it, in %1.json and a .sol: %2.</source>
        <translation>À côté, dans %1.json et un .sol : %2.</translation>
    </message>
    <message>
        <source>The case is the folder that the file lies in.</source>
        <translation>Le cas est le dossier où se trouve le fichier.</translation>
    </message>
    <message>
        <source>%1 is there already. Replace it?</source>
        <translation>%1 existe déjà. Le remplacer ?</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Figures</name>
    <message>
        <source>Comma-separated values (*.csv)</source>
        <translation>Valeurs séparées par des virgules (*.csv)</translation>
    </message>
    <message>
        <source>Save figures</source>
        <translation>Enregistrer les valeurs</translation>
    </message>
    <message>
        <source>Picture (*.png)</source>
        <translation>Image (*.png)</translation>
    </message>
    <message>
        <source>%1: figures are written as .csv or .png.</source>
        <translation>%1 : les valeurs s&apos;écrivent en .csv ou en .png.</translation>
    </message>
    <message>
        <source>Give the file one of these endings.</source>
        <translation>Donnez au fichier l&apos;une de ces terminaisons.</translation>
    </message>
    <message>
        <source>%1 could not be written.</source>
        <translation>%1 n&apos;a pas pu être écrit.</translation>
    </message>
    <message>
        <source>Is the folder writable?</source>
        <translation>Le dossier est-il accessible en écriture ?</translation>
    </message>
</context>
<context>
    <name>lamella::ui::FlowPanel</name>
    <message>
        <source>Acceleration</source>
        <translation>Accélération</translation>
    </message>
    <message>
        <source>Velocity</source>
        <translation>Vitesse</translation>
    </message>
    <message>
        <source>Strain rate</source>
        <translation>Taux de déformation</translation>
    </message>
    <message>
        <source>Change of direction</source>
        <translation>Changement de direction</translation>
    </message>
    <message>
        <source>Residual</source>
        <translation>Résidu</translation>
    </message>
    <message>
        <source>Directional residual</source>
        <translation>Résidu directionnel</translation>
    </message>
    <message>
        <source>Correct the mesh by the flow</source>
        <translation>Corriger le maillage par l&apos;écoulement</translation>
    </message>
    <message>
        <source>A run solves the flow once the mesh has settled, refines where the flow asks for it, and meshes again</source>
        <translation>Un calcul résout l&apos;écoulement une fois le maillage stabilisé, raffine là où l&apos;écoulement le demande, et remaille</translation>
    </message>
    <message>
        <source>What the mesh is to follow: the gradient of a field, or an indicator
that is made even over the elements</source>
        <translation>Ce que le maillage doit suivre : le gradient d&apos;un champ, ou un indicateur
rendu uniforme sur les éléments</translation>
    </message>
    <message>
        <source>By</source>
        <translation>Par</translation>
    </message>
    <message>
        <source>Strength</source>
        <translation>Force</translation>
    </message>
    <message>
        <source>Elements that the correction may ask for, over those without it</source>
        <translation>Éléments que la correction peut demander, rapportés à ceux sans elle</translation>
    </message>
    <message>
        <source>Elements at most</source>
        <translation>Éléments au plus</translation>
    </message>
    <message>
        <source>Rounds of flow and correction; 0: the flow is solved alone</source>
        <translation>Passes d&apos;écoulement et de correction ; 0 : l&apos;écoulement seul est résolu</translation>
    </message>
    <message>
        <source>Rounds</source>
        <translation>Passes</translation>
    </message>
    <message>
        <source>Correct by the flow</source>
        <translation>Corriger par l&apos;écoulement</translation>
    </message>
    <message>
        <source>No correction by the flow</source>
        <translation>Pas de correction par l&apos;écoulement</translation>
    </message>
    <message>
        <source>Correct by %1</source>
        <translation>Corriger par %1</translation>
    </message>
    <message>
        <source>Strength of the flow</source>
        <translation>Force de l&apos;écoulement</translation>
    </message>
    <message>
        <source>Elements for the flow</source>
        <translation>Éléments pour l&apos;écoulement</translation>
    </message>
    <message>
        <source>Rounds of the flow</source>
        <translation>Passes de l&apos;écoulement</translation>
    </message>
    <message>
        <source>Mean error</source>
        <translation>Erreur moyenne</translation>
    </message>
    <message>
        <source>To the right the flow asks for smaller sizes</source>
        <translation>Vers la droite, l&apos;écoulement demande des tailles plus petites</translation>
    </message>
    <message>
        <source>To the right the mean error is to be smaller</source>
        <translation>Vers la droite, l&apos;erreur moyenne doit être plus petite</translation>
    </message>
    <message>
        <source>Solve the flow to see what the correction comes to.</source>
        <translation>Résolvez l&apos;écoulement pour voir ce que donne la correction.</translation>
    </message>
    <message>
        <source>Counting…</source>
        <translation>Comptage…</translation>
    </message>
    <message>
        <source>About %L1 nodes instead of %L2, × %3.</source>
        <translation>Environ %L1 nœuds au lieu de %L2, × %3.</translation>
    </message>
    <message>
        <source>residual</source>
        <translation>résidu</translation>
    </message>
    <message>
        <source>Solving… Shift+F5 cancels.</source>
        <translation>Résolution… Maj+F5 annule.</translation>
    </message>
    <message>
        <source>Make a gate and a vent of groups of faces, and run: the flow between them is solved through the mesh.</source>
        <translation>Faites de groupes de faces un seuil et un évent, et lancez le calcul : l&apos;écoulement entre eux est résolu à travers le maillage.</translation>
    </message>
    <message>
        <source>No flow is known through this mesh. It needs a group that is a gate and one that is a vent.</source>
        <translation>Aucun écoulement n&apos;est connu dans ce maillage. Il lui faut un groupe qui soit un seuil et un qui soit un évent.</translation>
    </message>
    <message>
        <source>mm³/s</source>
        <translation>mm³/s</translation>
    </message>
    <message>
        <source>MPa</source>
        <translation>MPa</translation>
    </message>
    <message>
        <source>in by %1</source>
        <translation>entre par %1</translation>
    </message>
    <message>
        <source>out by %1</source>
        <translation>sort par %1</translation>
    </message>
    <message>
        <source>%1 iterations; %2 of what enters is lost.</source>
        <translation>%1 itérations ; %2 de ce qui entre se perd.</translation>
    </message>
    <message>
        <source>Velocity and curvature</source>
        <translation>Vitesse et courbure</translation>
    </message>
    <message>
        <source>Gradient of the field</source>
        <translation>Gradient du champ</translation>
    </message>
    <message>
        <source>Field as an indicator</source>
        <translation>Champ comme indicateur</translation>
    </message>
    <message>
        <source>The correction asks for no less</source>
        <translation>La correction ne demande rien de plus petit</translation>
    </message>
    <message>
        <source>of the body</source>
        <translation>celle du corps</translation>
    </message>
    <message>
        <source>Smallest size</source>
        <translation>Taille minimale</translation>
    </message>
    <message>
        <source>Flow, solved here</source>
        <translation>Écoulement, résolu ici</translation>
    </message>
    <message>
        <source>Result of another solver</source>
        <translation>Résultat d&apos;un autre solveur</translation>
    </message>
    <message>
        <source>A Stokes flow between gates and vents, or what Moldflow, OpenFOAM
or any other solver has found, on whatever mesh</source>
        <translation>Un écoulement de Stokes entre seuils et évents, ou ce que Moldflow, OpenFOAM
ou tout autre solveur a trouvé, sur n&apos;importe quel maillage</translation>
    </message>
    <message>
        <source>From</source>
        <translation>D&apos;après</translation>
    </message>
    <message>
        <source>File</source>
        <translation>Fichier</translation>
    </message>
    <message>
        <source>Numbers and vectors that the file has, at its points or cells</source>
        <translation>Nombres et vecteurs du fichier, à ses points ou dans ses cellules</translation>
    </message>
    <message>
        <source>Unit of length of the file</source>
        <translation>Unité de longueur du fichier</translation>
    </message>
    <message>
        <source>Unit of length of the file, which names none</source>
        <translation>Unité de longueur du fichier, qui n&apos;en nomme aucune</translation>
    </message>
    <message>
        <source>Field, unit</source>
        <translation>Champ, unité</translation>
    </message>
    <message>
        <source>Field %1</source>
        <translation>Champ %1</translation>
    </message>
    <message>
        <source>Unit of the result</source>
        <translation>Unité du résultat</translation>
    </message>
    <message>
        <source>Smallest size for the flow</source>
        <translation>Taille minimale pour l&apos;écoulement</translation>
    </message>
    <message>
        <source>What the correction comes to is known once the field is on the mesh.</source>
        <translation>Ce que donne la correction est connu une fois le champ posé sur le maillage.</translation>
    </message>
    <message>
        <source>Laying the field on the mesh…</source>
        <translation>Pose du champ sur le maillage…</translation>
    </message>
    <message>
        <source>nodes of the result</source>
        <translation>nœuds du résultat</translation>
    </message>
    <message>
        <source>change along an edge, mean</source>
        <translation>variation le long d&apos;une arête, moyenne</translation>
    </message>
    <message>
        <source>indicator, mean</source>
        <translation>indicateur, moyenne</translation>
    </message>
    <message>
        <source>one iteration before</source>
        <translation>une itération avant</translation>
    </message>
    <message>
        <source>The file is read when the mesh is run or the field is shown.</source>
        <translation>Le fichier est lu au lancement du calcul, ou quand le champ est affiché.</translation>
    </message>
    <message>
        <source>Run: the mesh that has settled is then corrected by the field.</source>
        <translation>Lancez le calcul : le maillage stabilisé est ensuite corrigé par le champ.</translation>
    </message>
    <message>
        <source>The field is not on this mesh.</source>
        <translation>Le champ n&apos;est pas sur ce maillage.</translation>
    </message>
    <message>
        <source>extent of the result</source>
        <translation>étendue du résultat</translation>
    </message>
    <message>
        <source>extent of the bodies</source>
        <translation>étendue des corps</translation>
    </message>
    <message>
        <source>nodes beside the result</source>
        <translation>nœuds hors du résultat</translation>
    </message>
    <message>
        <source>%L1, up to %2</source>
        <translation>%L1, jusqu&apos;à %2</translation>
    </message>
    <message>
        <source>Arrows</source>
        <translation>Flèches</translation>
    </message>
    <message>
        <source>Lines</source>
        <translation>Lignes</translation>
    </message>
    <message>
        <source>Levels</source>
        <translation>Niveaux</translation>
    </message>
    <message>
        <source>Flow</source>
        <translation>Écoulement</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Forecaster</name>
    <message>
        <source>Not known for one mesh of all bodies.</source>
        <translation>Inconnu pour un maillage de tous les corps.</translation>
    </message>
    <message>
        <source>Counting…</source>
        <translation>Décompte…</translation>
    </message>
    <message>
        <source>Not known yet.</source>
        <translation>Pas encore connu.</translation>
    </message>
    <message>
        <source>About %L1 nodes and %L2 elements; meshing takes about %L3 MB.</source>
        <translation>Environ %L1 nœuds et %L2 éléments ; mailler prend environ %L3 Mo.</translation>
    </message>
    <message>
        <source>Without the sizes: %L1 nodes.</source>
        <translation>Sans les tailles : %L1 nœuds.</translation>
    </message>
    <message>
        <source>At most about %L1 nodes and %L2 elements; meshing takes about %L3 MB.</source>
        <translation>Au plus environ %L1 nœuds et %L2 éléments ; le maillage prend environ %L3 Mo.</translation>
    </message>
    <message>
        <source>The flow is solved %1 times; before it: %L2 nodes.</source>
        <translation>L’écoulement est résolu %1 fois ; avant lui : %L2 nœuds.</translation>
    </message>
    <message>
        <source>Before the correction by the solver&apos;s field: %L1 nodes.</source>
        <translation>Avant la correction par le champ du solveur : %L1 nœuds.</translation>
    </message>
</context>
<context>
    <name>lamella::ui::GroupPage</name>
    <message>
        <source>Boundary group</source>
        <translation>Groupe de frontière</translation>
    </message>
    <message>
        <source>The name in the files that are written</source>
        <translation>Le nom dans les fichiers écrits</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Nom</translation>
    </message>
    <message>
        <source>What the simulation is to take it for</source>
        <translation>Ce que la simulation doit y voir</translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>Genre</translation>
    </message>
    <message>
        <source>Body</source>
        <translation>Corps</translation>
    </message>
    <message>
        <source>Area</source>
        <translation>Aire</translation>
    </message>
    <message>
        <source>Faces</source>
        <translation>Faces</translation>
    </message>
    <message>
        <source>A flood crosses edges where the surface turns by no more than this</source>
        <translation>Une inondation franchit les arêtes où la surface ne tourne pas plus que cela</translation>
    </message>
    <message>
        <source>Del takes the selected ones out</source>
        <translation>Suppr retire celles qui sont sélectionnées</translation>
    </message>
    <message>
        <source>Take out</source>
        <translation>Retirer</translation>
    </message>
    <message>
        <source>Rename group %1</source>
        <translation>Renommer le groupe %1</translation>
    </message>
    <message>
        <source>Kind of group %1</source>
        <translation>Genre du groupe %1</translation>
    </message>
    <message>
        <source>Take faces out of %1</source>
        <translation>Retirer des faces de %1</translation>
    </message>
    <message>
        <source>that of the first face picked</source>
        <translation>celui de la première face désignée</translation>
    </message>
    <message>
        <source>face %1, %2</source>
        <translation>face %1, %2</translation>
    </message>
    <message>
        <source>face %1</source>
        <translation>face %1</translation>
    </message>
    <message>
        <source>faces called %1</source>
        <translation>faces nommées %1</translation>
    </message>
    <message>
        <source>from (%1, %2, %3) up to %4°</source>
        <translation>de (%1, %2, %3) jusqu&apos;à %4°</translation>
    </message>
    <message>
        <source>pick its faces in the view</source>
        <translation>faces à désigner</translation>
    </message>
    <message>
        <source>by its pressure</source>
        <translation>par sa pression</translation>
    </message>
    <message>
        <source>by its rate</source>
        <translation>par son débit</translation>
    </message>
    <message>
        <source>What is known of the flow that enters; the other one follows</source>
        <translation>Ce que l&apos;on sait de l&apos;écoulement entrant ; l&apos;autre en résulte</translation>
    </message>
    <message>
        <source>Flow</source>
        <translation>Écoulement</translation>
    </message>
    <message>
        <source>Of the flow through the gate</source>
        <translation>De l&apos;écoulement par le seuil</translation>
    </message>
    <message>
        <source>Flow through %1</source>
        <translation>Écoulement par %1</translation>
    </message>
    <message>
        <source> mm³/s</source>
        <translation> mm³/s</translation>
    </message>
    <message>
        <source> MPa</source>
        <translation> MPa</translation>
    </message>
    <message>
        <source>Faces by name</source>
        <translation>Faces par nom</translation>
    </message>
    <message>
        <source>All faces that have this name in the CAD file</source>
        <translation>Toutes les faces qui ont ce nom dans le fichier CAO</translation>
    </message>
    <message>
        <source>Correct near it</source>
        <translation>Corriger auprès</translation>
    </message>
    <message>
        <source>Puts a sphere with a size of its own around the group</source>
        <translation>Met une sphère avec sa propre taille autour du groupe</translation>
    </message>
    <message>
        <source>Faces by name of %1</source>
        <translation>Faces par nom de %1</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Journal</name>
    <message>
        <source>Undone: %1</source>
        <translation>Annulé : %1</translation>
    </message>
    <message>
        <source>Done again: %1</source>
        <translation>Rétabli : %1</translation>
    </message>
    <message>
        <source>Edit: %1</source>
        <translation>Modification : %1</translation>
    </message>
</context>
<context>
    <name>lamella::ui::JournalView</name>
    <message>
        <source>Journal</source>
        <translation>Journal des actions</translation>
    </message>
    <message>
        <source>Nothing yet</source>
        <translation>Rien encore</translation>
    </message>
    <message>
        <source>Until the last crash</source>
        <translation>Jusqu&apos;au dernier arrêt brutal</translation>
    </message>
    <message>
        <source>Since this start</source>
        <translation>Depuis ce démarrage</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Legends</name>
    <message>
        <source>Wall thickness</source>
        <translation>Épaisseur de paroi</translation>
    </message>
    <message>
        <source>Quality c(T)</source>
        <translation>Qualité c(T)</translation>
    </message>
    <message>
        <source>Layers through the wall, %1 asked</source>
        <translation>Couches à travers la paroi, %1 demandées</translation>
    </message>
    <message>
        <source>no wall to count in</source>
        <translation>pas de paroi où compter</translation>
    </message>
    <message>
        <source>Filled by %1</source>
        <translation>Rempli par %1</translation>
    </message>
    <message>
        <source>0 %</source>
        <translation>0 %</translation>
    </message>
    <message>
        <source>&lt; 50 %</source>
        <translation>&lt; 50 %</translation>
    </message>
    <message>
        <source>≥ 50 %</source>
        <translation>≥ 50 %</translation>
    </message>
    <message>
        <source>100 %</source>
        <translation>100 %</translation>
    </message>
    <message>
        <source>Layers through the wall</source>
        <translation>Couches à travers la paroi</translation>
    </message>
    <message>
        <source>Filling ratio</source>
        <translation>Taux de remplissage</translation>
    </message>
    <message>
        <source>known once the part is meshed</source>
        <translation>connu une fois la pièce maillée</translation>
    </message>
    <message>
        <source>this mesh has no fuzzy interfaces</source>
        <translation>ce maillage n&apos;a pas d&apos;interfaces floues</translation>
    </message>
    <message>
        <source>not in this mesh</source>
        <translation>absent de ce maillage</translation>
    </message>
    <message>
        <source>Velocity, mm/s</source>
        <translation>Vitesse, mm/s</translation>
    </message>
    <message>
        <source>Pressure, MPa</source>
        <translation>Pression, MPa</translation>
    </message>
    <message>
        <source>Shear rate, 1/s</source>
        <translation>Taux de cisaillement, 1/s</translation>
    </message>
    <message>
        <source>Flow indicator</source>
        <translation>Indicateur d&apos;écoulement</translation>
    </message>
    <message>
        <source>known once the flow is solved</source>
        <translation>connu une fois l&apos;écoulement résolu</translation>
    </message>
    <message>
        <source>Smallest size asked</source>
        <translation>Plus petite taille demandée</translation>
    </message>
    <message>
        <source>Solver&apos;s field</source>
        <translation>Champ d&apos;un solveur</translation>
    </message>
    <message>
        <source>Indicator</source>
        <translation>Indicateur</translation>
    </message>
    <message>
        <source>known once another solver&apos;s result is read</source>
        <translation>connu une fois lu le résultat d&apos;un autre solveur</translation>
    </message>
</context>
<context>
    <name>lamella::ui::LengthBox</name>
    <message>
        <source>automatic</source>
        <translation>automatique</translation>
    </message>
</context>
<context>
    <name>lamella::ui::LogPanel</name>
    <message>
        <source>Log</source>
        <translation>Journal</translation>
    </message>
</context>
<context>
    <name>lamella::ui::MainWindow</name>
    <message>
        <source>Convergence</source>
        <translation>Convergence</translation>
    </message>
    <message>
        <source>Quality</source>
        <translation>Qualité</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>Rapport</translation>
    </message>
    <message>
        <source>Overlaps and gaps</source>
        <translation>Recouvrements et jeux</translation>
    </message>
    <message>
        <source>Log</source>
        <translation>Journal</translation>
    </message>
    <message>
        <source>&amp;File</source>
        <translation>&amp;Fichier</translation>
    </message>
    <message>
        <source>&amp;Edit</source>
        <translation>É&amp;dition</translation>
    </message>
    <message>
        <source>&amp;Study</source>
        <translation>&amp;Étude</translation>
    </message>
    <message>
        <source>&amp;Mesh</source>
        <translation>&amp;Maillage</translation>
    </message>
    <message>
        <source>&amp;View</source>
        <translation>&amp;Affichage</translation>
    </message>
    <message>
        <source>&amp;Help</source>
        <translation>&amp;Aide</translation>
    </message>
    <message>
        <source>Main</source>
        <translation>Principale</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>Ouvrir</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Enregistrer</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>Lancer</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Pause</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Arrêter</translation>
    </message>
    <message>
        <source>Group</source>
        <translation>Groupe</translation>
    </message>
    <message>
        <source>Correct near</source>
        <translation>Corriger ici</translation>
    </message>
    <message>
        <source>Section</source>
        <translation>Coupe</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>Exporter</translation>
    </message>
    <message>
        <source>Picture</source>
        <translation>Image</translation>
    </message>
    <message>
        <source>Saved %1</source>
        <translation>%1 enregistré</translation>
    </message>
    <message>
        <source>Mesh written</source>
        <translation>Maillage écrit</translation>
    </message>
    <message>
        <source>Mesh written: %1</source>
        <translation>Maillage écrit : %1</translation>
    </message>
    <message>
        <source>If that is not its size, read it again in its own unit.</source>
        <translation>Si ce n&apos;est pas sa taille, relisez-le dans son unité.</translation>
    </message>
    <message>
        <source>Inches</source>
        <translation>Pouces</translation>
    </message>
    <message>
        <source>Centimeters</source>
        <translation>Centimètres</translation>
    </message>
    <message>
        <source>Meters</source>
        <translation>Mètres</translation>
    </message>
    <message>
        <source>Lamella %1</source>
        <translation>Lamella %1</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Annuler</translation>
    </message>
    <message>
        <source>Undo: %1</source>
        <translation>Annuler : %1</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>Rétablir</translation>
    </message>
    <message>
        <source>Redo: %1</source>
        <translation>Rétablir : %1</translation>
    </message>
    <message>
        <source>Lamella</source>
        <translation>Lamella</translation>
    </message>
    <message>
        <source>%1[*] – Lamella</source>
        <translation>%1[*] – Lamella</translation>
    </message>
    <message>
        <source>%L1 nodes     %L2 elements</source>
        <translation>%L1 nœuds     %L2 éléments</translation>
    </message>
    <message>
        <source>     layers %1 (5 %: %2)</source>
        <translation>     couches %1 (5 % : %2)</translation>
    </message>
    <message>
        <source>     %L1 mixed</source>
        <translation>     %L1 mixtes</translation>
    </message>
    <message>
        <source>1 body</source>
        <translation>1 corps</translation>
    </message>
    <message>
        <source>%1 bodies</source>
        <translation>%1 corps</translation>
    </message>
    <message>
        <source>     %L1 surface triangles</source>
        <translation>     %L1 triangles de surface</translation>
    </message>
    <message>
        <source>     forecast: %L1 nodes, %L2 MB</source>
        <translation>     prévision : %L1 nœuds, %L2 Mo</translation>
    </message>
    <message>
        <source>Cancelling…</source>
        <translation>Arrêt…</translation>
    </message>
    <message>
        <source>Paused</source>
        <translation>Suspendu</translation>
    </message>
    <message>
        <source>Opening…</source>
        <translation>Ouverture…</translation>
    </message>
    <message>
        <source>Exporting…</source>
        <translation>Exportation…</translation>
    </message>
    <message>
        <source>Looking…</source>
        <translation>Recherche…</translation>
    </message>
    <message>
        <source>Running…</source>
        <translation>Calcul…</translation>
    </message>
    <message>
        <source>Ready</source>
        <translation>Prêt</translation>
    </message>
    <message>
        <source>Counting the mesh to expect…</source>
        <translation>Décompte du maillage à prévoir…</translation>
    </message>
    <message>
        <source>Settings changed since this mesh: run again</source>
        <translation>Réglages changés depuis ce maillage : relancez</translation>
    </message>
    <message>
        <source>Cancelled, best mesh kept</source>
        <translation>Arrêté, meilleur maillage gardé</translation>
    </message>
    <message>
        <source>Converged in %1 s</source>
        <translation>Convergé en %1 s</translation>
    </message>
    <message>
        <source>Stopped at the iteration limit</source>
        <translation>Arrêté à la limite d&apos;itérations</translation>
    </message>
    <message>
        <source>Mesh opened</source>
        <translation>Maillage ouvert</translation>
    </message>
    <message>
        <source>Ready to run</source>
        <translation>Prêt à lancer</translation>
    </message>
    <message>
        <source>Iteration %1 of at most %2%3</source>
        <translation>Itération %1 sur %2 au plus%3</translation>
    </message>
    <message>
        <source>   %1 %</source>
        <translation>   %1 %</translation>
    </message>
    <message>
        <source>   %1 left</source>
        <translation>   encore %1</translation>
    </message>
    <message>
        <source>The report tells where layers are missing. More iterations, or a smaller smallest size at blades, help.</source>
        <translation>Le rapport dit où manquent des couches. Davantage d&apos;itérations, ou une taille minimale plus petite aux lames, aident.</translation>
    </message>
    <message>
        <source>Add bodies</source>
        <translation>Ajouter des corps</translation>
    </message>
    <message>
        <source>Save study</source>
        <translation>Enregistrer l&apos;étude</translation>
    </message>
    <message>
        <source>Unsaved changes</source>
        <translation>Modifications non enregistrées</translation>
    </message>
    <message>
        <source>The study “%1” has changes that are not saved.</source>
        <translation>L&apos;étude « %1 » a des modifications non enregistrées.</translation>
    </message>
    <message>
        <source>Save them?</source>
        <translation>Les enregistrer ?</translation>
    </message>
    <message>
        <source>sphere</source>
        <translation>sphère</translation>
    </message>
    <message>
        <source>box</source>
        <translation>boîte</translation>
    </message>
    <message>
        <source>cylinder</source>
        <translation>cylindre</translation>
    </message>
    <message>
        <source>ball</source>
        <translation>boule</translation>
    </message>
    <message>
        <source>half-space</source>
        <translation>demi-espace</translation>
    </message>
    <message>
        <source>Drop the memory budget</source>
        <translation>Retirer la limite de mémoire</translation>
    </message>
    <message>
        <source>This mesh takes about %L1 MB, more than the budget of %L2 MB.</source>
        <translation>Ce maillage prend environ %L1 Mo, plus que la limite de %L2 Mo.</translation>
    </message>
    <message>
        <source>Ask for fewer layers, or raise the budget under Advanced.</source>
        <translation>Demandez moins de couches, ou relevez la limite sous Avancé.</translation>
    </message>
    <message>
        <source>Run without a budget</source>
        <translation>Lancer sans limite</translation>
    </message>
    <message>
        <source>PNG, %1 × %2 pixels (*.png)</source>
        <translation>PNG, %1 × %2 pixels (*.png)</translation>
    </message>
    <message>
        <source>Save picture</source>
        <translation>Enregistrer l&apos;image</translation>
    </message>
    <message>
        <source>Picture written</source>
        <translation>Image écrite</translation>
    </message>
    <message>
        <source>%1 could not be written.</source>
        <translation>%1 n&apos;a pas pu être écrit.</translation>
    </message>
    <message>
        <source>Is the folder writable, and does the name end in .png?</source>
        <translation>Le dossier est-il accessible en écriture, et le nom finit-il par .png ?</translation>
    </message>
    <message>
        <source>Results</source>
        <translation>Résultats</translation>
    </message>
    <message>
        <source>Flow</source>
        <translation>Écoulement</translation>
    </message>
    <message>
        <source>Saving…</source>
        <translation>Enregistrement…</translation>
    </message>
    <message>
        <source>Solving the flow…</source>
        <translation>Résolution de l&apos;écoulement…</translation>
    </message>
    <message>
        <source>Project (*.lamella)</source>
        <translation>Projet (*.lamella)</translation>
    </message>
    <message>
        <source>Project with copies of its parts, to hand on (*.lamella)</source>
        <translation>Projet avec copies de ses pièces, à transmettre (*.lamella)</translation>
    </message>
    <message>
        <source>Study as text, without meshes (*.json)</source>
        <translation>Étude en texte, sans maillages (*.json)</translation>
    </message>
    <message>
        <source>Link the parts</source>
        <translation>Lier les pièces</translation>
    </message>
    <message>
        <source>Keep copies of the parts</source>
        <translation>Garder des copies des pièces</translation>
    </message>
    <message>
        <source>Nothing is saved while something is under way.</source>
        <translation>Rien n&apos;est enregistré pendant qu&apos;une opération est en cours.</translation>
    </message>
    <message>
        <source>Cancel it, or save when it is done.</source>
        <translation>Annulez-la, ou enregistrez quand elle est finie.</translation>
    </message>
    <message>
        <source>The mesh of “%1” is not saved.</source>
        <translation>Le maillage de « %1 » n&apos;est pas enregistré.</translation>
    </message>
    <message>
        <source>Save it in a project?</source>
        <translation>L&apos;enregistrer dans un projet ?</translation>
    </message>
    <message>
        <source>Report written</source>
        <translation>Rapport écrit</translation>
    </message>
    <message>
        <source>PDF (*.pdf)</source>
        <translation>PDF (*.pdf)</translation>
    </message>
    <message>
        <source>HTML page (*.html)</source>
        <translation>Page HTML (*.html)</translation>
    </message>
    <message>
        <source>Save report</source>
        <translation>Enregistrer le rapport</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Démarrage</translation>
    </message>
    <message>
        <source>Studies and parts (*.lamella *.json %1);;Meshes (%2);;All files (*)</source>
        <translation>Études et pièces (*.lamella *.json %1);;Maillages (%2);;Tous les fichiers (*)</translation>
    </message>
    <message>
        <source>&amp;Solve the flow</source>
        <translation>&amp;Résoudre l&apos;écoulement</translation>
    </message>
    <message>
        <source>Lay the field of the other solver on the mesh that is shown</source>
        <translation>Poser le champ de l&apos;autre solveur sur le maillage affiché</translation>
    </message>
    <message>
        <source>Solve the flow between gates and vents through the mesh that is shown</source>
        <translation>Résoudre l&apos;écoulement entre seuils et évents à travers le maillage affiché</translation>
    </message>
    <message>
        <source>Laying the field on the mesh…</source>
        <translation>Pose du champ sur le maillage…</translation>
    </message>
    <message>
        <source>Result of another solver</source>
        <translation>Résultat d&apos;un autre solveur</translation>
    </message>
    <message>
        <source>Results (*.vtu *.vtk %1);;All files (*)</source>
        <translation>Résultats (*.vtu *.vtk %1);;Tous les fichiers (*)</translation>
    </message>
    <message>
        <source>What is it?</source>
        <translation>De quoi s&apos;agit-il ?</translation>
    </message>
    <message>
        <source>“%1” may be the result of another solver.</source>
        <translation>« %1 » peut être le résultat d&apos;un autre solveur.</translation>
    </message>
    <message>
        <source>Its fields can show where the mesh of what is open must be finer.</source>
        <translation>Ses champs peuvent montrer où le maillage de ce qui est ouvert doit être plus fin.</translation>
    </message>
    <message>
        <source>Correct by its fields</source>
        <translation>Corriger par ses champs</translation>
    </message>
    <message>
        <source>Open as a mesh</source>
        <translation>Ouvrir comme maillage</translation>
    </message>
    <message>
        <source>&amp;Show the field</source>
        <translation>&amp;Afficher le champ</translation>
    </message>
    <message>
        <source>The unit of all lengths; Preferences change it</source>
        <translation>L’unité de toutes les longueurs ; les préférences la changent</translation>
    </message>
    <message>
        <source>Anisotropic tetrahedral meshes for injection molding. Apache License 2.0.
Made with %1.</source>
        <translation>Maillages tétraédriques anisotropes pour le moulage par injection. Licence Apache 2.0.
Réalisé avec %1.</translation>
    </message>
    <message>
        <source>&amp;Results</source>
        <translation>&amp;Résultats</translation>
    </message>
    <message>
        <source>Millimeters</source>
        <translation>Millimètres</translation>
    </message>
    <message>
        <source>That is right</source>
        <translation>C’est juste</translation>
    </message>
    <message>
        <source>An STL has no unit: by its size it is in %1, that is %2.</source>
        <translation>Un STL n’a pas d’unité : d’après sa taille il est en %1, soit %2.</translation>
    </message>
    <message>
        <source>PNG of another width (*.png)</source>
        <translation>PNG d’une autre largeur (*.png)</translation>
    </message>
    <message>
        <source>Width in pixels</source>
        <translation>Largeur en pixels</translation>
    </message>
    <message>
        <source>Show</source>
        <translation>Montrer</translation>
    </message>
    <message>
        <source>Solve</source>
        <translation>Résoudre</translation>
    </message>
    <message>
        <source>The mesh is valid but had not settled at iteration %1.</source>
        <translation>Le maillage est valide mais n&apos;était pas stabilisé à l&apos;itération %1.</translation>
    </message>
    <message>
        <source>Parts (%1);;Bodies of meshes (%2)</source>
        <translation>Pièces (%1);;Corps de maillages (%2)</translation>
    </message>
</context>
<context>
    <name>lamella::ui::MeshPage</name>
    <message>
        <source>Mesh</source>
        <translation>Maillage</translation>
    </message>
    <message>
        <source>The boundary of the mesh stays this close to the part.
Empty: automatic, 1/1000 of the diagonal of each body</source>
        <translation>La frontière du maillage reste aussi près de la pièce.
Vide : automatique, 1/1000 de la diagonale de chaque corps</translation>
    </message>
    <message>
        <source>Chord tolerance</source>
        <translation>Tolérance de corde</translation>
    </message>
    <message>
        <source>Stops earlier once layers and nodes have settled</source>
        <translation>Finit plus tôt une fois les couches et les nœuds stables</translation>
    </message>
    <message>
        <source>Iterations at most</source>
        <translation>Itérations au plus</translation>
    </message>
    <message>
        <source>Advanced</source>
        <translation>Avancé</translation>
    </message>
    <message>
        <source>when settled</source>
        <translation>une fois stable</translation>
    </message>
    <message>
        <source>Ends once layers and nodes have settled; otherwise all iterations are made</source>
        <translation>Finit quand couches et nœuds sont stables ; sinon toutes les itérations sont faites</translation>
    </message>
    <message>
        <source>End</source>
        <translation>Fin</translation>
    </message>
    <message>
        <source>2, 3, .. n layers</source>
        <translation>2, 3, .. n couches</translation>
    </message>
    <message>
        <source>The first iterations ask for fewer layers: less memory at the peak,
which is in the first iteration</source>
        <translation>Les premières itérations demandent moins de couches : moins de mémoire au pic,
qui est dans la première itération</translation>
    </message>
    <message>
        <source>Progressive</source>
        <translation>Progressif</translation>
    </message>
    <message>
        <source>rays and balls</source>
        <translation>rayons et boules</translation>
    </message>
    <message>
        <source>neighborhoods</source>
        <translation>voisinages</translation>
    </message>
    <message>
        <source>Who finds the thickness of the walls: rays and balls inside the part,
or neighborhoods grown in the mesh, as in the thesis</source>
        <translation>Qui trouve l&apos;épaisseur des parois : des rayons et des boules dans la pièce,
ou des voisinages grandis dans le maillage, comme dans la thèse</translation>
    </message>
    <message>
        <source>Thickness by</source>
        <translation>Épaisseur par</translation>
    </message>
    <message>
        <source>Another seed gives another, equally good mesh; the same one the same</source>
        <translation>Une autre graine donne un autre maillage, aussi bon ; la même, le même</translation>
    </message>
    <message>
        <source>Seed</source>
        <translation>Graine</translation>
    </message>
    <message>
        <source>The mesh does not depend on it</source>
        <translation>Le maillage n&apos;en dépend pas</translation>
    </message>
    <message>
        <source>all cores</source>
        <translation>tous les cœurs</translation>
    </message>
    <message>
        <source>Threads</source>
        <translation>Processeurs</translation>
    </message>
    <message>
        <source>A run that is expected to take more does not start</source>
        <translation>Un calcul qui devrait prendre plus ne démarre pas</translation>
    </message>
    <message>
        <source>no bound</source>
        <translation>sans limite</translation>
    </message>
    <message>
        <source> MB</source>
        <translation> Mo</translation>
    </message>
    <message>
        <source>Memory budget</source>
        <translation>Limite de mémoire</translation>
    </message>
    <message>
        <source>Iterations</source>
        <translation>Itérations</translation>
    </message>
    <message>
        <source>End when settled</source>
        <translation>Finir une fois stable</translation>
    </message>
    <message>
        <source>Progressive layers</source>
        <translation>Couches progressives</translation>
    </message>
    <message>
        <source>Thickness detector</source>
        <translation>Détecteur d&apos;épaisseur</translation>
    </message>
    <message>
        <source>auto: %1</source>
        <translation>auto : %1</translation>
    </message>
    <message>
        <source>auto: %1 to %2</source>
        <translation>auto : %1 à %2</translation>
    </message>
    <message>
        <source>Longest over shortest size of an element. Solvers by finite volumes
and Moldflow like 10 to 20; each halving costs about four times the
nodes along the walls</source>
        <translation>Plus grande taille d&apos;un élément sur la plus petite. Les solveurs à volumes finis
et Moldflow préfèrent 10 à 20 ; chaque division par deux coûte environ quatre fois
les nœuds le long des parois</translation>
    </message>
    <message>
        <source>Anisotropy at most</source>
        <translation>Anisotropie au plus</translation>
    </message>
</context>
<context>
    <name>lamella::ui::ModelView</name>
    <message>
        <source>Shape of %1</source>
        <translation>Forme de %1</translation>
    </message>
    <message>
        <source>Move %1</source>
        <translation>Déplacer %1</translation>
    </message>
    <message>
        <source>No OpenGL 3.2 here: the model cannot be shown.
Meshing, report and export work as usual.</source>
        <translation>Pas d&apos;OpenGL 3.2 ici : le modèle ne peut pas être montré.
Maillage, rapport et exportation fonctionnent comme d&apos;habitude.</translation>
    </message>
    <message>
        <source>Hide %1</source>
        <translation>Cacher %1</translation>
    </message>
    <message>
        <source>New boundary group of this face</source>
        <translation>Nouveau groupe de frontière de cette face</translation>
    </message>
    <message>
        <source>Give this face a size</source>
        <translation>Donner une taille à cette face</translation>
    </message>
    <message>
        <source>face size</source>
        <translation>taille de face</translation>
    </message>
    <message>
        <source>Correct near this point</source>
        <translation>Corriger près de ce point</translation>
    </message>
    <message>
        <source>Show all bodies</source>
        <translation>Montrer tous les corps</translation>
    </message>
    <message>
        <source>Turn %1 on</source>
        <translation>Activer %1</translation>
    </message>
    <message>
        <source>Turn the cuts off</source>
        <translation>Désactiver les coupes</translation>
    </message>
</context>
<context>
    <name>lamella::ui::OverlapPanel</name>
    <message>
        <source>Show</source>
        <translation>Montrer</translation>
    </message>
    <message>
        <source>Cut open</source>
        <translation>Ouvrir par une coupe</translation>
    </message>
    <message>
        <source>Look</source>
        <translation>Chercher</translation>
    </message>
    <message>
        <source>Find where bodies overlap, and where they leave gaps</source>
        <translation>Trouver où des corps se recouvrent, et où ils laissent des jeux</translation>
    </message>
    <message>
        <source>for overlaps, and for gaps narrower than</source>
        <translation>les recouvrements, et les jeux plus étroits que</translation>
    </message>
    <message>
        <source>Gaps between bodies that are narrower are listed too.
Empty: overlaps only</source>
        <translation>Les jeux plus étroits entre corps sont listés aussi.
Vide : recouvrements seuls</translation>
    </message>
    <message>
        <source>overlaps only</source>
        <translation>recouvrements seuls</translation>
    </message>
    <message>
        <source>Looking… Shift+F5 cancels.</source>
        <translation>Recherche… Maj+F5 arrête.</translation>
    </message>
    <message>
        <source>With two bodies or more, overlaps and gaps between them are listed here.</source>
        <translation>Avec deux corps ou plus, leurs recouvrements et leurs jeux sont listés ici.</translation>
    </message>
    <message>
        <source>Overlaps of bodies and gaps between them are listed here. In one mesh of all bodies the first body keeps what two share.</source>
        <translation>Les recouvrements de corps et les jeux entre eux sont listés ici. En un seul maillage, le premier corps garde ce que deux partagent.</translation>
    </message>
    <message>
        <source>No bodies overlap.</source>
        <translation>Aucun corps n&apos;en recouvre un autre.</translation>
    </message>
    <message>
        <source>1 overlap</source>
        <translation>1 recouvrement</translation>
    </message>
    <message>
        <source>%1 overlaps</source>
        <translation>%1 recouvrements</translation>
    </message>
    <message>
        <source>Bodies</source>
        <translation>Corps</translation>
    </message>
    <message>
        <source>Volume</source>
        <translation>Volume</translation>
    </message>
    <message>
        <source>Depth</source>
        <translation>Profondeur</translation>
    </message>
    <message>
        <source>%1 and %2</source>
        <translation>%1 et %2</translation>
    </message>
    <message>
        <source>%1 lies wholly in the other</source>
        <translation>%1 est entièrement dans l&apos;autre</translation>
    </message>
    <message>
        <source>No gaps are narrower than %1.</source>
        <translation>Aucun jeu n&apos;est plus étroit que %1.</translation>
    </message>
    <message>
        <source>narrower than %1</source>
        <translation>plus étroits que %1</translation>
    </message>
    <message>
        <source>1 gap</source>
        <translation>1 jeu</translation>
    </message>
    <message>
        <source>%1 gaps</source>
        <translation>%1 jeux</translation>
    </message>
    <message>
        <source>Narrowest</source>
        <translation>Le plus étroit</translation>
    </message>
    <message>
        <source>mean</source>
        <translation>moyenne</translation>
    </message>
    <message>
        <source>Found in %1 s</source>
        <translation>Trouvé en %1 s</translation>
    </message>
    <message>
        <source>overlap %1 deep</source>
        <translation>recouvrement profond de %1</translation>
    </message>
    <message>
        <source>gap of %1</source>
        <translation>jeu de %1</translation>
    </message>
    <message>
        <source>Overlaps and gaps</source>
        <translation>Recouvrements et jeux</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Palette</name>
    <message>
        <source>What do you want to do?</source>
        <translation>Que voulez-vous faire ?</translation>
    </message>
    <message>
        <source>Search actions</source>
        <translation>Chercher une action</translation>
    </message>
</context>
<context>
    <name>lamella::ui::PickTools</name>
    <message>
        <source>near gate</source>
        <translation>près du seuil</translation>
    </message>
    <message>
        <source>face size</source>
        <translation>taille de face</translation>
    </message>
    <message>
        <source>Flood %1 from a point</source>
        <translation>Inonder %1 depuis un point</translation>
    </message>
    <message>
        <source>This mesh has no metric</source>
        <translation>Ce maillage n&apos;a pas de métrique</translation>
    </message>
    <message>
        <source>asked: %1</source>
        <translation>demandé : %1</translation>
    </message>
    <message>
        <source>wall: %1</source>
        <translation>paroi : %1</translation>
    </message>
    <message>
        <source>Click faces to add them to “%1” or to take them out. Esc ends.</source>
        <translation>Cliquez des faces pour les ajouter à « %1 » ou les en retirer. Échap finit.</translation>
    </message>
    <message>
        <source>Click the first face of a new group. Esc ends.</source>
        <translation>Cliquez la première face d&apos;un nouveau groupe. Échap finit.</translation>
    </message>
    <message>
        <source>Click where the group is to begin. Esc ends.</source>
        <translation>Cliquez où le groupe doit commencer. Échap finit.</translation>
    </message>
    <message>
        <source>Click the gate, or any place that needs a size of its own. Esc ends.</source>
        <translation>Cliquez le seuil, ou tout endroit qui demande sa propre taille. Échap finit.</translation>
    </message>
    <message>
        <source>Click the face that is to have a size of its own. Esc ends.</source>
        <translation>Cliquez la face qui doit avoir sa propre taille. Échap finit.</translation>
    </message>
    <message>
        <source>Click the second place. Esc ends.</source>
        <translation>Cliquez le second endroit. Échap finit.</translation>
    </message>
    <message>
        <source>A third place gives the angle. Esc ends.</source>
        <translation>Un troisième endroit donne l&apos;angle. Échap finit.</translation>
    </message>
    <message>
        <source>Click two places to see their distance. Esc ends.</source>
        <translation>Cliquez deux endroits pour voir leur distance. Échap finit.</translation>
    </message>
    <message>
        <source>Click the mesh to see the sizes asked there. Esc ends.</source>
        <translation>Cliquez le maillage pour voir les tailles demandées là. Échap finit.</translation>
    </message>
    <message>
        <source>Sizes are known once there is a mesh. Esc ends.</source>
        <translation>Les tailles sont connues une fois le maillage fait. Échap finit.</translation>
    </message>
    <message>
        <source>Draw a rectangle around what is to come close. Esc ends.</source>
        <translation>Tracez un rectangle autour de ce qui doit s&apos;approcher. Échap finit.</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Plot</name>
    <message>
        <source>Nothing yet</source>
        <translation>Rien encore</translation>
    </message>
    <message>
        <source>Iteration %1</source>
        <translation>Itération %1</translation>
    </message>
    <message>
        <source>not measured</source>
        <translation>non mesuré</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Preferences</name>
    <message>
        <source>Preferences</source>
        <translation>Préférences</translation>
    </message>
    <message>
        <source>light</source>
        <translation>clair</translation>
    </message>
    <message>
        <source>dark</source>
        <translation>sombre</translation>
    </message>
    <message>
        <source>Theme</source>
        <translation>Thème</translation>
    </message>
    <message>
        <source>In what lengths are shown and entered; files keep millimeters</source>
        <translation>Dans quoi les longueurs sont montrées et saisies ; les fichiers gardent les millimètres</translation>
    </message>
    <message>
        <source>millimeters</source>
        <translation>millimètres</translation>
    </message>
    <message>
        <source>inches</source>
        <translation>pouces</translation>
    </message>
    <message>
        <source>Lengths in</source>
        <translation>Longueurs en</translation>
    </message>
    <message>
        <source>From the next start on</source>
        <translation>Au prochain démarrage</translation>
    </message>
    <message>
        <source>Language</source>
        <translation>Langue</translation>
    </message>
    <message>
        <source>Of studies begun from now on: a run that is expected to take more does not start</source>
        <translation>Des études commencées désormais : un calcul qui devrait prendre plus ne démarre pas</translation>
    </message>
    <message>
        <source>no bound</source>
        <translation>sans limite</translation>
    </message>
    <message>
        <source> MB</source>
        <translation> Mo</translation>
    </message>
    <message>
        <source>Memory budget</source>
        <translation>Limite de mémoire</translation>
    </message>
    <message>
        <source>Of studies begun from now on</source>
        <translation>Des études commencées désormais</translation>
    </message>
    <message>
        <source>all cores</source>
        <translation>tous les cœurs</translation>
    </message>
    <message>
        <source>Threads</source>
        <translation>Processeurs</translation>
    </message>
</context>
<context>
    <name>lamella::ui::PropertiesPanel</name>
    <message>
        <source>The settings of what is selected appear here.</source>
        <translation>Les réglages de ce qui est sélectionné apparaissent ici.</translation>
    </message>
    <message>
        <source>Settings</source>
        <translation>Réglages</translation>
    </message>
</context>
<context>
    <name>lamella::ui::QualityPanel</name>
    <message>
        <source>Draw a range to see only its elements; click to see all again.
The bars grow with the logarithm of the count</source>
        <translation>Tracez un intervalle pour ne voir que ses éléments ; cliquez pour les revoir tous.
Les barres croissent comme le logarithme du nombre</translation>
    </message>
    <message>
        <source>Save the counts as a table, or the histogram as a picture</source>
        <translation>Enregistrer les nombres en tableau, ou l&apos;histogramme en image</translation>
    </message>
    <message>
        <source>Save figures</source>
        <translation>Enregistrer les valeurs</translation>
    </message>
    <message>
        <source>Quality of the elements, 1 is best</source>
        <translation>Qualité des éléments, 1 est la meilleure</translation>
    </message>
    <message>
        <source>     %1 to %2: %L3 of %L4 elements</source>
        <translation>     %1 à %2 : %L3 éléments sur %L4</translation>
    </message>
    <message>
        <source>Nothing yet</source>
        <translation>Rien encore</translation>
    </message>
</context>
<context>
    <name>lamella::ui::RecoveryDialog</name>
    <message>
        <source>1 body</source>
        <translation>1 corps</translation>
    </message>
    <message>
        <source>%1 bodies</source>
        <translation>%1 corps</translation>
    </message>
    <message>
        <source>1 group</source>
        <translation>1 groupe</translation>
    </message>
    <message>
        <source>%1 groups</source>
        <translation>%1 groupes</translation>
    </message>
    <message>
        <source>1 size</source>
        <translation>1 taille</translation>
    </message>
    <message>
        <source>%1 sizes</source>
        <translation>%1 tailles</translation>
    </message>
    <message>
        <source>1 cut</source>
        <translation>1 coupe</translation>
    </message>
    <message>
        <source>%1 cuts</source>
        <translation>%1 coupes</translation>
    </message>
    <message>
        <source>an empty study</source>
        <translation>une étude vide</translation>
    </message>
    <message>
        <source>Recovery</source>
        <translation>Récupération</translation>
    </message>
    <message>
        <source>Lamella ended without saving your work.</source>
        <translation>Lamella s&apos;est terminé sans enregistrer votre travail.</translation>
    </message>
    <message>
        <source>The study was kept with its last edit. Meshes since the last save are not in it: run it again.</source>
        <translation>L&apos;étude a été gardée avec sa dernière modification, mais sans les maillages faits depuis le dernier enregistrement : relancez-la.</translation>
    </message>
    <message>
        <source>Studies that were kept</source>
        <translation>Études gardées</translation>
    </message>
    <message>
        <source>never saved</source>
        <translation>jamais enregistré</translation>
    </message>
    <message>
        <source>&amp;Recover</source>
        <translation>&amp;Récupérer</translation>
    </message>
    <message>
        <source>&amp;Discard</source>
        <translation>&amp;Supprimer</translation>
    </message>
    <message>
        <source>Decide &amp;later</source>
        <translation>Décider plus &amp;tard</translation>
    </message>
    <message>
        <source>&amp;What was done</source>
        <translation>Ce qui a été &amp;fait</translation>
    </message>
    <message>
        <source>Study</source>
        <translation>Étude</translation>
    </message>
    <message>
        <source>Project</source>
        <translation>Projet</translation>
    </message>
    <message>
        <source>Last edit</source>
        <translation>Dernière modification</translation>
    </message>
    <message>
        <source>Kept</source>
        <translation>Gardé</translation>
    </message>
</context>
<context>
    <name>lamella::ui::ReportPanel</name>
    <message>
        <source>The report of a finished run appears here.</source>
        <translation>Le rapport d&apos;un calcul achevé apparaît ici.</translation>
    </message>
    <message>
        <source>Cancelled: the best mesh so far</source>
        <translation>Arrêté : le meilleur maillage obtenu</translation>
    </message>
    <message>
        <source>Converged</source>
        <translation>Convergé</translation>
    </message>
    <message>
        <source>Stopped at the limit of iterations</source>
        <translation>Arrêté à la limite d&apos;itérations</translation>
    </message>
    <message>
        <source>in %1 s</source>
        <translation>en %1 s</translation>
    </message>
    <message>
        <source>Body</source>
        <translation>Corps</translation>
    </message>
    <message>
        <source>Layers asked</source>
        <translation>Couches demandées</translation>
    </message>
    <message>
        <source>mean</source>
        <translation>moyenne</translation>
    </message>
    <message>
        <source>5 %</source>
        <translation>5 %</translation>
    </message>
    <message>
        <source>median</source>
        <translation>médiane</translation>
    </message>
    <message>
        <source>places reached</source>
        <translation>endroits atteints</translation>
    </message>
    <message>
        <source>Distance to surface</source>
        <translation>Distance à la surface</translation>
    </message>
    <message>
        <source>%1 %</source>
        <translation>%1 %</translation>
    </message>
    <message>
        <source>–</source>
        <translation>–</translation>
    </message>
    <message>
        <source>%1 of %2</source>
        <translation>%1 sur %2</translation>
    </message>
    <message>
        <source>%L1 of %L2 elements are mixed: filled in part by several bodies</source>
        <translation>%L1 éléments sur %L2 sont mixtes : remplis en partie par plusieurs corps</translation>
    </message>
    <message>
        <source>interface error %1 %</source>
        <translation>erreur d&apos;interface %1 %</translation>
    </message>
    <message>
        <source>%1 across its borders</source>
        <translation>%1 à travers ses frontières</translation>
    </message>
    <message>
        <source>%1: places with fewer than %2 layers, the largest first</source>
        <translation>%1 : endroits ayant moins de %2 couches, les plus grands d&apos;abord</translation>
    </message>
    <message>
        <source>Show</source>
        <translation>Montrer</translation>
    </message>
    <message>
        <source>%1 layers</source>
        <translation>%1 couches</translation>
    </message>
    <message>
        <source>on %1</source>
        <translation>sur %1</translation>
    </message>
    <message>
        <source>and %1 smaller ones</source>
        <translation>et %1 plus petits</translation>
    </message>
    <message>
        <source>%1 of %2 layers</source>
        <translation>%1 couches sur %2</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>Rapport</translation>
    </message>
    <message>
        <source>Save as PDF or HTML…</source>
        <translation>Enregistrer en PDF ou en HTML…</translation>
    </message>
    <message>
        <source>Volume off the CAD&apos;s</source>
        <translation>Écart de volume</translation>
    </message>
    <message>
        <source>volume %1, first mesh by %2</source>
        <translation>volume %1, premier maillage par %2</translation>
    </message>
    <message>
        <source>near %1</source>
        <translation>près de %1</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Session</name>
    <message>
        <source>1 body</source>
        <translation>1 corps</translation>
    </message>
    <message>
        <source>%1 bodies</source>
        <translation>%1 corps</translation>
    </message>
    <message>
        <source>Cancelled.</source>
        <translation>Arrêté.</translation>
    </message>
    <message>
        <source>Opening %1</source>
        <translation>Ouverture de %1</translation>
    </message>
    <message>
        <source>Opening the study %1</source>
        <translation>Ouverture de l&apos;étude %1</translation>
    </message>
    <message>
        <source>Saved %1</source>
        <translation>%1 enregistré</translation>
    </message>
    <message>
        <source>Making the sample part “%1”</source>
        <translation>Création de la pièce d&apos;exemple « %1 »</translation>
    </message>
    <message>
        <source>Opening the mesh %1</source>
        <translation>Ouverture du maillage %1</translation>
    </message>
    <message>
        <source>Drop the domain</source>
        <translation>Retirer le domaine</translation>
    </message>
    <message>
        <source>Remove group %1</source>
        <translation>Supprimer le groupe %1</translation>
    </message>
    <message>
        <source>Remove size %1</source>
        <translation>Supprimer la taille %1</translation>
    </message>
    <message>
        <source>Remove %1</source>
        <translation>Supprimer %1</translation>
    </message>
    <message>
        <source>Run: %1, at most %2 iterations</source>
        <translation>Calcul : %1, %2 itérations au plus</translation>
    </message>
    <message>
        <source>Iteration %1: %L2 nodes, %L3 elements, layers %4 (5 %: %5), %6 s</source>
        <translation>Itération %1 : %L2 nœuds, %L3 éléments, couches %4 (5 % : %5), %6 s</translation>
    </message>
    <message>
        <source>%L1 mixed elements, interface error %2</source>
        <translation>%L1 éléments mixtes, erreur d&apos;interface %2</translation>
    </message>
    <message>
        <source>%1: first mesh by %2, layers %3 asked, %4 on average (5 %: %5)</source>
        <translation>%1 : premier maillage par %2, %3 couches demandées, %4 en moyenne (5 % : %5)</translation>
    </message>
    <message>
        <source>Cancelled after %1 s; the best mesh so far is kept.</source>
        <translation>Arrêté après %1 s ; le meilleur maillage obtenu est gardé.</translation>
    </message>
    <message>
        <source>Converged in %1 s.</source>
        <translation>Convergé en %1 s.</translation>
    </message>
    <message>
        <source>Stopped after %1 s at the limit of iterations.</source>
        <translation>Arrêté après %1 s à la limite d&apos;itérations.</translation>
    </message>
    <message>
        <source>Paused.</source>
        <translation>Suspendu.</translation>
    </message>
    <message>
        <source>Goes on.</source>
        <translation>Reprise.</translation>
    </message>
    <message>
        <source>Exporting %1</source>
        <translation>Exportation de %1</translation>
    </message>
    <message>
        <source>Wrote %1</source>
        <translation>%1 écrit</translation>
    </message>
    <message>
        <source>%1 of %2</source>
        <translation>%1 sur %2</translation>
    </message>
    <message>
        <source>%1 of %2 bodies</source>
        <translation>%1 de %2 corps</translation>
    </message>
    <message>
        <source>Remove zone %1</source>
        <translation>Supprimer la zone %1</translation>
    </message>
    <message>
        <source>Looking for overlaps and gaps</source>
        <translation>Recherche de recouvrements et de jeux</translation>
    </message>
    <message>
        <source>%1 overlaps and %2 gaps</source>
        <translation>%1 recouvrements et %2 jeux</translation>
    </message>
    <message>
        <source>The study is open, but not all is as it was saved.</source>
        <translation>L&apos;étude est ouverte, mais tout n&apos;est pas comme à l&apos;enregistrement.</translation>
    </message>
    <message>
        <source>Saved, but not all of it.</source>
        <translation>Enregistré, mais pas en entier.</translation>
    </message>
    <message>
        <source>Solving the flow through %L1 nodes</source>
        <translation>Résolution de l&apos;écoulement à travers %L1 nœuds</translation>
    </message>
    <message>
        <source>Flow: %1 iterations, %2 mm³/s, %3 s</source>
        <translation>Écoulement : %1 itérations, %2 mm³/s, %3 s</translation>
    </message>
    <message>
        <source>Reading the result %1</source>
        <translation>Lecture du résultat %1</translation>
    </message>
    <message>
        <source>Correct by the result %1</source>
        <translation>Corriger par le résultat %1</translation>
    </message>
    <message>
        <source>Lengths in %1 are taken for %2.</source>
        <translation>Les longueurs de %1 sont prises pour des %2.</translation>
    </message>
    <message>
        <source>The result is then %1 across, and the bodies are %2. If that is wrong, choose its unit in the flow panel.</source>
        <translation>Le résultat mesure alors %1, et les corps %2. Si c&apos;est faux, choisissez son unité dans le panneau de l&apos;écoulement.</translation>
    </message>
    <message>
        <source>Laying the solver&apos;s field on %L1 nodes</source>
        <translation>Pose du champ du solveur sur %L1 nœuds</translation>
    </message>
    <message>
        <source>%1: %2, %L3 triangles on %4 faces, volume %5</source>
        <translation>%1 : %2, %L3 triangles sur %4 faces, volume %5</translation>
    </message>
    <message>
        <source>Reload the parts</source>
        <translation>Recharger les pièces</translation>
    </message>
    <message>
        <source>Reading the files of the parts again</source>
        <translation>Relecture des fichiers des pièces</translation>
    </message>
    <message>
        <source>The parts are as their files have them.</source>
        <translation>Les pièces sont conformes à leurs fichiers.</translation>
    </message>
    <message>
        <source>The part was read again.</source>
        <translation>La pièce a été relue.</translation>
    </message>
    <message>
        <source>%1 parts were read again.</source>
        <translation>%1 pièces ont été relues.</translation>
    </message>
    <message>
        <source>Its settings, groups and sizes are as they were.</source>
        <translation>Réglages, groupes et tailles sont inchangés.</translation>
    </message>
</context>
<context>
    <name>lamella::ui::ShortcutSheet</name>
    <message>
        <source>Keyboard shortcuts</source>
        <translation>Raccourcis clavier</translation>
    </message>
    <message>
        <source>left drag</source>
        <translation>glisser à gauche</translation>
    </message>
    <message>
        <source>turn the view</source>
        <translation>tourner la vue</translation>
    </message>
    <message>
        <source>middle drag</source>
        <translation>glisser au milieu</translation>
    </message>
    <message>
        <source>shift it (or Shift and left)</source>
        <translation>la déplacer (ou Maj et gauche)</translation>
    </message>
    <message>
        <source>wheel</source>
        <translation>molette</translation>
    </message>
    <message>
        <source>zoom towards the pointer</source>
        <translation>zoom vers le pointeur</translation>
    </message>
    <message>
        <source>click</source>
        <translation>clic</translation>
    </message>
    <message>
        <source>select a body; Ctrl adds</source>
        <translation>sélectionner un corps ; Ctrl ajoute</translation>
    </message>
    <message>
        <source>right click</source>
        <translation>clic droit</translation>
    </message>
    <message>
        <source>what can be done there</source>
        <translation>ce que l&apos;on peut faire là</translation>
    </message>
    <message>
        <source>Esc</source>
        <translation>Échap</translation>
    </message>
    <message>
        <source>end picking, forget what was measured</source>
        <translation>finir de désigner, oublier les mesures</translation>
    </message>
    <message>
        <source>F2</source>
        <translation>F2</translation>
    </message>
    <message>
        <source>rename in the study</source>
        <translation>renommer dans l&apos;étude</translation>
    </message>
    <message>
        <source>arrows, +, -</source>
        <translation>flèches, +, -</translation>
    </message>
    <message>
        <source>turn the view and zoom; with Shift shift it</source>
        <translation>tourner la vue et zoomer ; avec Maj la déplacer</translation>
    </message>
</context>
<context>
    <name>lamella::ui::SizingPage</name>
    <message>
        <source>Size at a place</source>
        <translation>Taille en un endroit</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Nom</translation>
    </message>
    <message>
        <source>The body whose elements get this size</source>
        <translation>Le corps dont les éléments ont cette taille</translation>
    </message>
    <message>
        <source>Body</source>
        <translation>Corps</translation>
    </message>
    <message>
        <source>An analytic zone: its sizes are set in the study file.</source>
        <translation>Une zone analytique : ses tailles se règlent dans le fichier d&apos;étude.</translation>
    </message>
    <message>
        <source>Mesh to expect</source>
        <translation>Maillage à prévoir</translation>
    </message>
    <message>
        <source>Rename %1</source>
        <translation>Renommer %1</translation>
    </message>
    <message>
        <source>Body of %1</source>
        <translation>Corps de %1</translation>
    </message>
    <message>
        <source>Center; drag its knob in the view</source>
        <translation>Centre ; tirez son bouton dans la vue</translation>
    </message>
    <message>
        <source>Center</source>
        <translation>Centre</translation>
    </message>
    <message>
        <source>Center of the other end</source>
        <translation>Centre de l&apos;autre extrémité</translation>
    </message>
    <message>
        <source>Other end</source>
        <translation>Autre extrémité</translation>
    </message>
    <message>
        <source>Lengths of the edges</source>
        <translation>Longueurs des arêtes</translation>
    </message>
    <message>
        <source>Edges</source>
        <translation>Arêtes</translation>
    </message>
    <message>
        <source>Radius; drag the outer knob in the view</source>
        <translation>Rayon ; tirez le bouton extérieur dans la vue</translation>
    </message>
    <message>
        <source>Radius</source>
        <translation>Rayon</translation>
    </message>
    <message>
        <source>Faces</source>
        <translation>Faces</translation>
    </message>
    <message>
        <source>How far below the faces the size holds</source>
        <translation>Jusqu&apos;où sous les faces la taille vaut</translation>
    </message>
    <message>
        <source>Depth</source>
        <translation>Profondeur</translation>
    </message>
    <message>
        <source>size</source>
        <translation>taille</translation>
    </message>
    <message>
        <source>× natural size</source>
        <translation>× naturelle</translation>
    </message>
    <message>
        <source>A size, or a factor of the size that the walls ask for there</source>
        <translation>Une taille, ou un facteur de la taille que les parois demandent là</translation>
    </message>
    <message>
        <source>Asks for</source>
        <translation>Demande</translation>
    </message>
    <message>
        <source>The smaller, the more elements. A factor above 1 is coarser, and needs
the directions kept</source>
        <translation>Plus c&apos;est petit, plus il y a d&apos;éléments. Un facteur au-dessus de 1 est plus
grossier, et demande que les directions soient gardées</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>Valeur</translation>
    </message>
    <message>
        <source>How fast sizes grow outside, per unit length</source>
        <translation>Combien vite les tailles croissent au-dehors, par unité de longueur</translation>
    </message>
    <message>
        <source>Growth outside</source>
        <translation>Croissance au-dehors</translation>
    </message>
    <message>
        <source>Scales the stretched elements of the walls instead of making them
equal in all directions: fewer elements</source>
        <translation>Réduit les éléments étirés des parois au lieu de les rendre
égaux en toutes directions : moins d&apos;éléments</translation>
    </message>
    <message>
        <source>Stretching</source>
        <translation>Étirement</translation>
    </message>
    <message>
        <source>What %1 asks</source>
        <translation>Ce que demande %1</translation>
    </message>
    <message>
        <source>Shape of %1</source>
        <translation>Forme de %1</translation>
    </message>
    <message>
        <source>all bodies</source>
        <translation>tous les corps</translation>
    </message>
    <message>
        <source>keep directions</source>
        <translation>garder les directions</translation>
    </message>
</context>
<context>
    <name>lamella::ui::StudyModel</name>
    <message>
        <source>Bodies</source>
        <translation>Corps</translation>
    </message>
    <message>
        <source>Groups</source>
        <translation>Groupes</translation>
    </message>
    <message>
        <source>Sizes</source>
        <translation>Tailles</translation>
    </message>
    <message>
        <source>Cuts</source>
        <translation>Coupes</translation>
    </message>
    <message>
        <source>Domain</source>
        <translation>Domaine</translation>
    </message>
    <message>
        <source>What is meshed, each body with its own settings</source>
        <translation>Ce qui est maillé, chaque corps avec ses réglages</translation>
    </message>
    <message>
        <source>Named parts of the boundary (gate, vent, symmetry): they go with
the mesh into the solver</source>
        <translation>Parties nommées de la frontière (seuil, évent, symétrie) : elles vont avec
le maillage dans le solveur</translation>
    </message>
    <message>
        <source>Places with a size of their own, such as the region of a gate</source>
        <translation>Endroits ayant leur propre taille, comme la région d&apos;un seuil</translation>
    </message>
    <message>
        <source>Planes that cut the model open to look inside</source>
        <translation>Plans qui ouvrent le modèle pour regarder dedans</translation>
    </message>
    <message>
        <source>What one mesh of all bodies fills</source>
        <translation>Ce que remplit un maillage de tous les corps</translation>
    </message>
    <message>
        <source>%1
The eye shows or hides the body; hidden bodies are meshed too.</source>
        <translation>%1
L&apos;œil montre ou cache le corps ; les corps cachés sont maillés aussi.</translation>
    </message>
    <message>
        <source>%1, a body without a file: its shape is a formula.
It is meshed in one mesh of all bodies.</source>
        <translation>%1, un corps sans fichier : sa forme est une formule.
Il est maillé avec tous les corps en un seul maillage.</translation>
    </message>
    <message>
        <source>What is around the bodies in the domain: it is meshed with them.
The eye shows it.</source>
        <translation>Ce qui entoure les corps dans le domaine : c&apos;est maillé avec eux.
L&apos;œil le montre.</translation>
    </message>
    <message>
        <source>n %1</source>
        <translation>n %1</translation>
    </message>
    <message>
        <source>Element layers through the wall thickness</source>
        <translation>Couches d&apos;éléments à travers l&apos;épaisseur de paroi</translation>
    </message>
    <message>
        <source>Layers measured in the mesh: %1 on average, 5 % of the walls below %2</source>
        <translation>Couches mesurées dans le maillage : %1 en moyenne, 5 % des parois sous %2</translation>
    </message>
    <message>
        <source>Layers measured in the mesh, once there is one</source>
        <translation>Couches mesurées dans le maillage, une fois qu&apos;il existe</translation>
    </message>
    <message>
        <source>%1 on %2</source>
        <translation>%1 sur %2</translation>
    </message>
    <message>
        <source>1 face</source>
        <translation>1 face</translation>
    </message>
    <message>
        <source>%1 faces</source>
        <translation>%1 faces</translation>
    </message>
    <message>
        <source>%1
for all bodies</source>
        <translation>%1
pour tous les corps</translation>
    </message>
    <message>
        <source>%1
for %2</source>
        <translation>%1
pour %2</translation>
    </message>
    <message>
        <source>× %1</source>
        <translation>× %1</translation>
    </message>
    <message>
        <source>The eye turns the cut on and off</source>
        <translation>L&apos;œil active et désactive la coupe</translation>
    </message>
    <message>
        <source>One mesh fills it and carries all bodies.
The mesh&apos;s properties have its settings.</source>
        <translation>Un maillage le remplit et porte tous les corps.
Les propriétés du maillage ont ses réglages.</translation>
    </message>
    <message>
        <source>fuzzy</source>
        <translation>floues</translation>
    </message>
    <message>
        <source>exact</source>
        <translation>exactes</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Nom</translation>
    </message>
    <message>
        <source>asked</source>
        <translation>visé</translation>
    </message>
    <message>
        <source>is</source>
        <translation>réel</translation>
    </message>
    <message>
        <source>Show %1</source>
        <translation>Montrer %1</translation>
    </message>
    <message>
        <source>Hide %1</source>
        <translation>Cacher %1</translation>
    </message>
    <message>
        <source>Layers of %1</source>
        <translation>Couches de %1</translation>
    </message>
    <message>
        <source>Turn %1 on</source>
        <translation>Activer %1</translation>
    </message>
    <message>
        <source>Turn %1 off</source>
        <translation>Désactiver %1</translation>
    </message>
    <message>
        <source>Rename %1</source>
        <translation>Renommer %1</translation>
    </message>
</context>
<context>
    <name>lamella::ui::StudyPanel</name>
    <message>
        <source>Study</source>
        <translation>Étude</translation>
    </message>
    <message>
        <source>Add a body, a boundary group, a size or a cut</source>
        <translation>Ajouter un corps, un groupe de frontière, une taille ou une coupe</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Ajouter</translation>
    </message>
    <message>
        <source>Show only the selection</source>
        <translation>Montrer la sélection seule</translation>
    </message>
    <message>
        <source>Show only this</source>
        <translation>Ne montrer que ceci</translation>
    </message>
    <message>
        <source>Show all bodies</source>
        <translation>Montrer tous les corps</translation>
    </message>
    <message>
        <source>Rename</source>
        <translation>Renommer</translation>
    </message>
</context>
<context>
    <name>lamella::ui::ViewBar</name>
    <message>
        <source>Color by</source>
        <translation>Couleur</translation>
    </message>
    <message>
        <source>Body</source>
        <translation>Corps</translation>
    </message>
    <message>
        <source>Quality c(T)</source>
        <translation>Qualité c(T)</translation>
    </message>
    <message>
        <source>Wall thickness</source>
        <translation>Épaisseur de paroi</translation>
    </message>
    <message>
        <source>Layers measured</source>
        <translation>Couches mesurées</translation>
    </message>
    <message>
        <source>Filling ratio</source>
        <translation>Remplissage</translation>
    </message>
    <message>
        <source>Body whose filling is shown</source>
        <translation>Corps dont le remplissage est montré</translation>
    </message>
    <message>
        <source>Body whose filling is shown: the selected one</source>
        <translation>Corps dont le remplissage est montré : celui qui est sélectionné</translation>
    </message>
    <message>
        <source>Standard views (keys 0 to 6)</source>
        <translation>Vues standard (touches 0 à 6)</translation>
    </message>
    <message>
        <source>Position of the cut</source>
        <translation>Position de la coupe</translation>
    </message>
    <message>
        <source>Velocity</source>
        <translation>Vitesse</translation>
    </message>
    <message>
        <source>Pressure</source>
        <translation>Pression</translation>
    </message>
    <message>
        <source>Shear rate</source>
        <translation>Taux de cisaillement</translation>
    </message>
    <message>
        <source>Flow indicator</source>
        <translation>Indicateur</translation>
    </message>
    <message>
        <source>Size asked</source>
        <translation>Taille demandée</translation>
    </message>
    <message>
        <source>Solver&apos;s field</source>
        <translation>Champ d&apos;un solveur</translation>
    </message>
</context>
<context>
    <name>lamella::ui::VtkView</name>
    <message>
        <source>Model</source>
        <translation>Modèle</translation>
    </message>
</context>
<context>
    <name>lamella::ui::WallMap</name>
    <message>
        <source>measuring… %1 %, Esc stops</source>
        <translation>mesure… %1 %, Échap arrête</translation>
    </message>
    <message>
        <source>stopped; choose it again to measure</source>
        <translation>arrêté ; choisissez-la de nouveau pour mesurer</translation>
    </message>
    <message>
        <source>measured after the run</source>
        <translation>mesuré après le calcul</translation>
    </message>
</context>
<context>
    <name>lamella::ui::Welcome</name>
    <message>
        <source>Lamella fills it with tetrahedra, n layers through every wall.</source>
        <translation>Lamella le remplit de tétraèdres, n couches à travers chaque paroi.</translation>
    </message>
    <message>
        <source>Open a file…</source>
        <translation>Ouvrir un fichier…</translation>
    </message>
    <message>
        <source>or start with a sample part</source>
        <translation>ou commencez avec une pièce d&apos;exemple</translation>
    </message>
    <message>
        <source>Ribbed tray</source>
        <translation>Bac nervuré</translation>
    </message>
    <message>
        <source>Ribs, bosses and fillets</source>
        <translation>Nervures, bossages et congés</translation>
    </message>
    <message>
        <source>Plate</source>
        <translation>Plaque</translation>
    </message>
    <message>
        <source>One thin wall</source>
        <translation>Une paroi mince</translation>
    </message>
    <message>
        <source>Curved shell</source>
        <translation>Coque courbe</translation>
    </message>
    <message>
        <source>A wall that bends</source>
        <translation>Une paroi qui se courbe</translation>
    </message>
    <message>
        <source>T-junction</source>
        <translation>Jonction en T</translation>
    </message>
    <message>
        <source>Where walls meet</source>
        <translation>Où des parois se rencontrent</translation>
    </message>
    <message>
        <source>Twisted tube</source>
        <translation>Tube torsadé</translation>
    </message>
    <message>
        <source>A tube in a cube</source>
        <translation>Un tube dans un cube</translation>
    </message>
    <message>
        <source>opened last</source>
        <translation>ouverts récemment</translation>
    </message>
    <message>
        <source>Drop a CAD or STL file here</source>
        <translation>Déposez ici un fichier CAO ou STL</translation>
    </message>
</context>
<context>
    <name>lamella::ui::WindowTools</name>
    <message>
        <source>Open &amp;recent</source>
        <translation>Ouvrir un fichier &amp;récent</translation>
    </message>
    <message>
        <source>Action: %1</source>
        <translation>Action : %1</translation>
    </message>
    <message>
        <source>Copied</source>
        <translation>Copié</translation>
    </message>
    <message>
        <source>Nothing yet</source>
        <translation>Rien encore</translation>
    </message>
</context>
<context>
    <name>lamella::ui::ZoneForm</name>
    <message>
        <source>Name</source>
        <translation>Nom</translation>
    </message>
    <message>
        <source>Drag its knob in the view</source>
        <translation>Tirez son bouton dans la vue</translation>
    </message>
    <message>
        <source>Center</source>
        <translation>Centre</translation>
    </message>
    <message>
        <source>Lower corner of a box, middle of one end of a cylinder</source>
        <translation>Coin inférieur d&apos;une boîte, milieu d&apos;une extrémité d&apos;un cylindre</translation>
    </message>
    <message>
        <source>From</source>
        <translation>De</translation>
    </message>
    <message>
        <source>Upper corner of a box, middle of the other end</source>
        <translation>Coin supérieur d&apos;une boîte, milieu de l&apos;autre extrémité</translation>
    </message>
    <message>
        <source>To</source>
        <translation>À</translation>
    </message>
    <message>
        <source>Across the plane: the body is on the other side</source>
        <translation>Perpendiculaire au plan : le corps est de l&apos;autre côté</translation>
    </message>
    <message>
        <source>Away from</source>
        <translation>Loin de</translation>
    </message>
    <message>
        <source>Where the plane is along that direction</source>
        <translation>Où est le plan le long de cette direction</translation>
    </message>
    <message>
        <source>Plane at</source>
        <translation>Plan à</translation>
    </message>
    <message>
        <source>Drag the outer knob in the view</source>
        <translation>Tirez le bouton extérieur dans la vue</translation>
    </message>
    <message>
        <source>Radius</source>
        <translation>Rayon</translation>
    </message>
    <message>
        <source>Shape of %1</source>
        <translation>Forme de %1</translation>
    </message>
</context>
</TS>

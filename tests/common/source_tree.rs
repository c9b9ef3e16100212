//! Which file of the crate uses which: read from the `use` lines and paths of the sources.

use std::collections::{BTreeMap, BTreeSet};

use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree};

/// The modules of a crate, and for each the modules whose items it uses.
pub struct SourceTree {
    uses: BTreeMap<String, BTreeSet<String>>,
}

/// A module: what it defines, and what it makes known under another path.
#[derive(Default)]
struct Module {
    defined: BTreeSet<String>,
    imported: BTreeMap<String, Vec<String>>,
    /// Absolute paths, from the crate's root.
    paths: Vec<Vec<String>>,
    /// Its modules in files of their own that only tests have.
    of_tests: Vec<String>,
}

impl SourceTree {
    /// From module paths (`planes::sweep`) and their sources.
    pub fn new(files: &BTreeMap<String, String>) -> Self {
        let mut modules: BTreeMap<&str, Module> = files
            .iter()
            .map(|(name, text)| (name.as_str(), read(name, text, files)))
            .collect();
        let of_tests: BTreeSet<String> = (modules.values())
            .flat_map(|module| module.of_tests.iter().cloned())
            .collect();
        // With all that stands below them.
        let is_of_tests = |name: &str| {
            let above = |end: usize| of_tests.contains(&name[..end]);
            of_tests.contains(name) || name.match_indices("::").any(|(end, _)| above(end))
        };
        modules.retain(|name, _| !is_of_tests(name));
        let mut uses = BTreeMap::new();
        for (name, module) in &modules {
            let targets = module
                .paths
                .iter()
                .filter_map(|path| definer(path, &modules, 0));
            let others: BTreeSet<String> =
                targets.filter(|t| t != name).map(str::to_owned).collect();
            uses.insert((*name).to_owned(), others);
        }
        Self { uses }
    }

    /// All pairs (user, used).
    pub fn arrows(&self) -> impl Iterator<Item = (&str, &str)> {
        self.uses
            .iter()
            .flat_map(|(from, targets)| targets.iter().map(move |to| (from.as_str(), to.as_str())))
    }
}

/// The circles: sets of modules of which each uses, by way of others, all the others.
pub fn circles(tree: &SourceTree) -> Vec<Vec<String>> {
    let reach = |start: &String| {
        let (mut seen, mut todo) = (BTreeSet::new(), vec![start]);
        while let Some(module) = todo.pop() {
            for next in tree.uses.get(module).into_iter().flatten() {
                if seen.insert(next.clone()) {
                    todo.push(next);
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&String, BTreeSet<String>> =
        tree.uses.keys().map(|m| (m, reach(m))).collect();
    let mut found: Vec<Vec<String>> = Vec::new();
    for (module, targets) in &reached {
        let circle: Vec<String> = (targets.iter())
            .filter(|t| reached.get(t).is_some_and(|back| back.contains(*module)))
            .cloned()
            .collect();
        if circle.len() > 1 && !found.contains(&circle) {
            found.push(circle);
        }
    }
    found
}

/// The module that defines what a path names, by way of re-exports.
fn definer<'m>(
    path: &[String],
    modules: &BTreeMap<&'m str, Module>,
    depth: usize,
) -> Option<&'m str> {
    // Deep enough for every chain of re-exports, and an end for circular ones.
    const DEEPEST: usize = 12;
    let parts = (1..=path.len()).rev();
    let known = |n: &usize| modules.contains_key(path[..*n].join("::").as_str());
    let length = parts.into_iter().find(known)?;
    let (&name, module) = modules.get_key_value(path[..length].join("::").as_str())?;
    let Some(item) = path.get(length) else {
        return Some(name);
    };
    match module.imported.get(item) {
        Some(target) if !module.defined.contains(item) && depth < DEEPEST => {
            let whole = [target.as_slice(), &path[length + 1..]].concat();
            definer(&whole, modules, depth + 1).or(Some(name))
        }
        _ => Some(name),
    }
}

fn read(name: &str, text: &str, files: &BTreeMap<String, String>) -> Module {
    let file = syn::parse_file(text).unwrap_or_else(|e| panic!("{name}: {e}"));
    let here: Vec<String> = name.split("::").map(str::to_owned).collect();
    let mut reader = Reader {
        here,
        files,
        module: Module::default(),
    };
    for item in &file.items {
        if let Some(defined) = name_of(item) {
            reader.module.defined.insert(defined);
        }
        // A module's own imports are known under their names here.
        if let Item::Use(use_item) = item
            && !only_for_tests(&use_item.attrs)
        {
            let mut leaves = Vec::new();
            flatten(&use_item.tree, Vec::new(), &mut leaves);
            let is_public = !matches!(use_item.vis, syn::Visibility::Inherited);
            for (path, known_as) in leaves {
                let Some(absolute) = reader.absolute(&path) else {
                    continue;
                };
                if !is_public {
                    reader.module.paths.push(absolute.clone());
                }
                reader.module.imported.insert(known_as, absolute);
            }
        } else {
            reader.visit_item(item);
        }
    }
    reader.module
}

/// The name of what an item defines.
fn name_of(item: &Item) -> Option<String> {
    Some(match item {
        Item::Fn(i) => i.sig.ident.to_string(),
        Item::Struct(i) => i.ident.to_string(),
        Item::Enum(i) => i.ident.to_string(),
        Item::Trait(i) => i.ident.to_string(),
        Item::Type(i) => i.ident.to_string(),
        Item::Const(i) => i.ident.to_string(),
        Item::Static(i) => i.ident.to_string(),
        _ => return None,
    })
}

fn only_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|a| {
        a.path().is_ident("cfg")
            && a.meta
                .require_list()
                .is_ok_and(|list| list.tokens.to_string() == "test")
    })
}

fn flatten(tree: &UseTree, mut path: Vec<String>, leaves: &mut Vec<(Vec<String>, String)>) {
    match tree {
        UseTree::Path(p) => {
            path.push(p.ident.to_string());
            flatten(&p.tree, path, leaves);
        }
        UseTree::Group(g) => g
            .items
            .iter()
            .for_each(|t| flatten(t, path.clone(), leaves)),
        UseTree::Name(n) if n.ident == "self" => {
            let name = path.last().cloned().unwrap_or_default();
            leaves.push((path, name));
        }
        UseTree::Name(n) => {
            path.push(n.ident.to_string());
            leaves.push((path, n.ident.to_string()));
        }
        UseTree::Rename(r) => {
            path.push(r.ident.to_string());
            leaves.push((path, r.rename.to_string()));
        }
        UseTree::Glob(_) => leaves.push((path, "*".to_owned())),
    }
}

struct Reader<'f> {
    here: Vec<String>,
    files: &'f BTreeMap<String, String>,
    module: Module,
}

impl Reader<'_> {
    /// A path from the crate's root; `None` for what lies outside of the crate.
    fn absolute(&self, path: &[String]) -> Option<Vec<String>> {
        let first = path.first()?;
        let mut base = self.here.clone();
        let mut rest = path;
        match first.as_str() {
            "crate" => return Some(path[1..].to_vec()),
            "self" => rest = &path[1..],
            "super" => {
                while rest.first().is_some_and(|s| s == "super") {
                    base.pop();
                    rest = &rest[1..];
                }
            }
            _ => {
                // A child module, or something that was imported.
                let child = [base.join("::"), first.clone()].join("::");
                if !self.files.contains_key(&child) {
                    let target = self.module.imported.get(first)?;
                    return Some([target.as_slice(), &path[1..]].concat());
                }
            }
        }
        Some([base.as_slice(), rest].concat())
    }
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        // Tests may use whatever they like.
        if !only_for_tests(&item.attrs) {
            visit::visit_item_mod(self, item);
        } else if item.content.is_none() {
            let name = [self.here.join("::"), item.ident.to_string()].join("::");
            self.module.of_tests.push(name);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        let mut leaves = Vec::new();
        flatten(&item.tree, Vec::new(), &mut leaves);
        let paths: Vec<Vec<String>> = leaves
            .iter()
            .filter_map(|(path, _)| self.absolute(path))
            .collect();
        self.module.paths.extend(paths);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let parts: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        let is_local = parts.len() < 2;
        if !is_local && let Some(absolute) = self.absolute(&parts) {
            self.module.paths.push(absolute);
        }
        visit::visit_path(self, path);
    }
}
